#include "live_handle.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include <hexhex/error.hpp>

#include "guard.hpp"

namespace hexhex::c {

namespace {

constexpr std::uint64_t kMagic = 0x6865786865782121U;  // hexhex!!

/// It lives as long as the memory rests, which is longer than the handle.
struct alignas(std::max_align_t) HandleHeader {
  std::uint64_t magic = kMagic;
  std::atomic<Destroyer> kind{nullptr};  ///< null: not given out yet
  std::atomic<std::uint64_t> users{0};
};
static_assert(alignof(HandleHeader) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);
static_assert(std::atomic<Destroyer>::is_always_lock_free &&
              std::atomic<std::uint64_t>::is_always_lock_free);

// Users: numbers of all and of readers, and bits. Nobody begins to use a doomed handle; the last
// who began before marks it as dead, and deletes it.
constexpr std::uint64_t kUser = 1;
constexpr std::uint64_t kReader = std::uint64_t{1} << 28;
constexpr std::uint64_t kReaders = ((std::uint64_t{1} << 56) - 1) & ~(kReader - 1);
constexpr std::uint64_t kChanging = std::uint64_t{1} << 60;
constexpr std::uint64_t kDoomed = std::uint64_t{1} << 61;
constexpr std::uint64_t kDead = std::uint64_t{1} << 62;

HandleHeader* headerOf(const void* handle) {
  return const_cast<HandleHeader*>(static_cast<const HandleHeader*>(handle)) - 1;
}

constexpr std::uint64_t partOf(Use use) {
  return kUser + (use == Use::Look ? 0 : (use == Use::Read ? kReader : kChanging));
}

/// What keeps a use from beginning.
constexpr std::uint64_t obstaclesTo(Use use) {
  return use == Use::Look ? 0 : (use == Use::Read ? kChanging : kChanging | kReaders);
}

enum class Found { Good, Missing, OtherKind, InUse };

/// Begins to use a handle, if it is good.
Found begin(const void* handle, Destroyer kind, Use use) noexcept {
  if (handle == nullptr) return Found::Missing;
  if (reinterpret_cast<std::uintptr_t>(handle) % alignof(HandleHeader) != 0) return Found::Missing;
  HandleHeader& header = *headerOf(handle);
  if (header.magic != kMagic) return Found::Missing;
  std::uint64_t users = header.users.load();
  do {
    if ((users & (kDoomed | kDead)) != 0) return Found::Missing;
    if (header.kind.load() != kind) return Found::OtherKind;
    if ((users & obstaclesTo(use)) != 0) return Found::InUse;
  } while (!header.users.compare_exchange_weak(users, users + partOf(use)));
  return Found::Good;
}

}  // namespace

void giveOut(const void* handle, Destroyer kind) noexcept { headerOf(handle)->kind.store(kind); }

bool tryUse(const void* handle, Destroyer kind, Use use) noexcept {
  return begin(handle, kind, use) == Found::Good;
}

void beginUse(const void* handle, Destroyer kind, Use use, const char* argument) {
  if (handle == nullptr) throwNull(argument);
  const Found found = begin(handle, kind, use);
  if (found == Found::Good) return;
  if (found == Found::InUse) throwBusy(argument);
  throw Error(ErrorCode::InvalidArgument,
              std::string("The argument `") + argument +
                  (found == Found::OtherKind
                       ? "` is a handle of another kind. Give one of the kind that it is for."
                       : "` is no handle: it was destroyed, or never made. Give one that lives."));
}

void endUse(const void* handle, Use use) noexcept {
  HandleHeader& header = *headerOf(handle);
  const std::uint64_t part = partOf(use);
  if (header.users.fetch_sub(part) - part != kDoomed) return;
  header.users.store(kDead);
  header.kind.load()(handle);
}

void destroyHandle(const void* handle, Destroyer kind) noexcept {
  if (begin(handle, kind, Use::Look) != Found::Good) return;
  headerOf(handle)->users.fetch_or(kDoomed);
  endUse(handle, Use::Look);
}

// Not inline, or compilers would see one half of a pair, and complain about the other.
[[gnu::noinline]] void* HandleMemory::operator new(std::size_t size) {
  auto* const header = new (::operator new(sizeof(HandleHeader) + size)) HandleHeader;
  return header + 1;
}

[[gnu::noinline]] void HandleMemory::operator delete(void* handle) noexcept {
  constexpr std::size_t kResting = 1024;  // of some hundred bytes each
  static std::array<std::atomic<HandleHeader*>, kResting> ring;
  static std::atomic<std::size_t> next{0};
  ::operator delete(ring[next.fetch_add(1) % kResting].exchange(headerOf(handle)));
}

}  // namespace hexhex::c
