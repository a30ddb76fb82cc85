#include "guard.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>

#include <hexhex/version.hpp>

static_assert(hexhex::c::statusOf(hexhex::ErrorCode::InvalidArgument) == HEXHEX_INVALID_ARGUMENT);
static_assert(hexhex::c::statusOf(hexhex::ErrorCode::FlippedTet) == HEXHEX_FLIPPED_TET);
static_assert(hexhex::c::statusOf(hexhex::ErrorCode::NotMeshable) == HEXHEX_NOT_MESHABLE);
static_assert(static_cast<int>(hexhex::PlaceKind::Cell) == HEXHEX_PLACE_CELL);
// Any int may come in: without an underlying type, reading another number would be undefined.
template <class... Enumerations>
constexpr bool kAreInts = (std::is_same_v<std::underlying_type_t<Enumerations>, int> && ...);
static_assert(kAreInts<hexhex_status, hexhex_place_kind, hexhex_chart_style, hexhex_defect_kind,
                       hexhex_answer_table, hexhex_output, hexhex_mesh_array, hexhex_engine,
                       hexhex_curved_nodes, hexhex_pillow_mode, hexhex_valence_table>);

namespace hexhex::c {

namespace {

/// Needs no memory, so that it works when there is none.
hexhex_status describe(hexhex_error* error, ErrorCode code, const char* message,
                       const Place& place = {}) noexcept {
  const hexhex_status status = statusOf(code);
  if (error != nullptr) {
    error->status = status;
    error->place = placeOf(place);
    static_cast<void>(std::snprintf(error->message, sizeof error->message, "%s", message));
  }
  return status;
}

}  // namespace

hexhex_place placeOf(const Place& place) noexcept {
  return {static_cast<hexhex_place_kind>(place.kind), place.index, place.second};
}

hexhex_status describeException(hexhex_error* error) noexcept {
  constexpr const char* kNoMemory =
      "Memory is exhausted. Use a smaller scale, or a machine with more memory.";
  try {
    throw;
  } catch (const Error& e) {
    return describe(error, e.code(), e.what(), e.place());
  } catch (const std::bad_alloc&) {
    return describe(error, ErrorCode::OutOfMemory, kNoMemory);
  } catch (const std::length_error&) {
    return describe(error, ErrorCode::OutOfMemory, kNoMemory);
  } catch (const std::system_error& e) {
    // A lock or a thread that the system refuses.
    return describe(error, ErrorCode::OutOfMemory, e.what());
  } catch (const std::exception& e) {
    return describe(error, ErrorCode::Internal, e.what());
  } catch (...) {
    return describe(error, ErrorCode::Internal,
                    "Something unknown was thrown. This is a bug; please report it with the map.");
  }
}

void throwNull(const char* argument) {
  throw Error(ErrorCode::InvalidArgument,
              std::string("The argument `") + argument + "` is NULL. Give something.");
}

void throwSize(const char* argument) {
  throw Error(ErrorCode::InvalidArgument,
              std::string("The member `size` of `") + argument +
                  "` is wrong, or something is set that this version of the library does not "
                  "know. Make the struct with its _INIT macro.");
}

void throwBusy(const char* argument) {
  throw Error(ErrorCode::InvalidArgument,
              std::string("The argument `") + argument +
                  "` is in use by another call. Give each call one of its own.");
}

void throwCount(const char* argument, std::size_t count) {
  throw Error(ErrorCode::InvalidArgument, std::string("The array `") + argument + "` cannot have " +
                                              std::to_string(count) +
                                              " elements. Set the number of those that it has.");
}

}  // namespace hexhex::c

const char* hexhex_version() { return hexhex::version(); }

size_t hexhex_place_text(const hexhex_place* place, char* text, size_t size) {
  if (text != nullptr && size > 0) *text = '\0';
  if (place == nullptr || place->kind < HEXHEX_PLACE_NONE || place->kind > HEXHEX_PLACE_CELL) {
    return 0;
  }
  size_t length = 0;
  const hexhex_status status = hexhex::c::guarded(nullptr, [&] {
    const std::string words = hexhex::toString(
        {static_cast<hexhex::PlaceKind>(place->kind), place->index, place->second});
    length = words.size();
    if (text != nullptr && size > 0) {
      *std::copy_n(words.begin(), std::min(length, size - 1), text) = '\0';
    }
  });
  return status == HEXHEX_OK ? length : 0;
}

const char* hexhex_status_name(hexhex_status status) {
  const int number = static_cast<int>(status);
  if (number == 0) return "Ok";
  if (number < 0 || number > static_cast<int>(hexhex::ErrorCode::Internal) + 1) return "Unknown";
  // Names are literals, so they end with a zero.
  return hexhex::name(static_cast<hexhex::ErrorCode>(number - 1)).data();
}
