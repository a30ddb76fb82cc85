#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <string>
#include <system_error>

#include <hexhex/error.hpp>
#include <hexhex/team.hpp>

namespace hexhex {

// Every function of a team begins by asking whether all processes are well. A process that has
// failed answers no, whichever function the others are in, and so all learn why.
void ProcessTeam::run(const std::function<void()>& work) {
  if (running_) return work();
  running_ = true;
  failed_ = false;
  std::optional<Error> failure;
  try {
    work();
  } catch (const Error& error) {
    failure = error;
  } catch (const std::bad_alloc&) {
    failure.emplace(ErrorCode::OutOfMemory, "The memory of this machine does not suffice.");
  } catch (const std::system_error& error) {
    failure.emplace(ErrorCode::OutOfMemory,
                    std::string("The system refuses threads or memory: ") + error.what());
  } catch (const std::exception& error) {
    failure.emplace(ErrorCode::Internal, error.what());
  }
  running_ = false;
  if (failed_) throw *failure;
  settle(failure ? &*failure : nullptr);
}

void ProcessTeam::settle(const Error* failure) {
  if (doAllSay(failure == nullptr)) return;
  failed_ = true;
  throw firstError(failure);
}

/// Ends the process if there is no memory for this: the others would wait forever.
Error ProcessTeam::firstError(const Error* failure) noexcept {
  constexpr std::size_t kNumbers = 5;
  std::array<std::uint64_t, kNumbers> mine{};
  std::string text;
  if (failure != nullptr) {
    const Place& place = failure->place();
    text = failure->what();
    mine = {static_cast<std::uint64_t>(failure->code()) + 1, text.size(),
            static_cast<std::uint64_t>(place.kind), place.index, place.second};
  }
  const std::vector<std::uint64_t> counts(size(), kNumbers);
  std::vector<std::uint64_t> all(kNumbers * counts.size());
  doGather(mine, counts, all);
  std::uint32_t first = 0;
  while (all[kNumbers * first] == 0) ++first;
  const auto numbers = std::span(all).subspan(kNumbers * first, kNumbers);
  text.resize(numbers[1]);
  doShare(first, std::as_writable_bytes(std::span(text)));
  if (first > 0) text = "Process " + std::to_string(first) + ": " + text;
  return {static_cast<ErrorCode>(numbers[0] - 1),
          text,
          {static_cast<PlaceKind>(numbers[2]), numbers[3], numbers[4]}};
}

void ProcessTeam::barrier() { settle(nullptr); }

void ProcessTeam::share(std::span<std::byte> bytes) {
  barrier();
  if (!bytes.empty()) doShare(0, bytes);
}

std::string ProcessTeam::shareText(const std::string& text) {
  std::uint64_t length = text.size();
  share(std::as_writable_bytes(std::span(&length, 1)));
  std::string shared = text;
  shared.resize(length);
  share(std::as_writable_bytes(std::span(shared)));
  return shared;
}

void ProcessTeam::requireSame(const std::string& text, const std::string& what) {
  run([&] {
    const std::string first = shareText(text);
    if (first == text) return;
    throw Error(ErrorCode::InvalidArgument, "the " + what + " here is \"" + text +
                                                "\", that of process 0 \"" + first +
                                                "\". Give all processes the same.");
  });
  barrier();  // nobody goes on before all are here
}

std::vector<std::uint64_t> ProcessTeam::gatherCounts(std::uint64_t count) {
  std::vector<std::uint64_t> counts(size());
  const std::vector<std::uint64_t> ones(size(), 1);
  barrier();
  doGather(std::span(&count, 1), ones, counts);
  return counts;
}

GatheredNumbers ProcessTeam::gather(std::span<const std::uint64_t> mine) {
  GatheredNumbers gathered;
  const std::vector<std::uint64_t> counts = gatherCounts(mine.size());
  gathered.begin.resize(counts.size() + 1);
  for (std::size_t r = 0; r < counts.size(); ++r) {
    gathered.begin[r + 1] = gathered.begin[r] + counts[r];
  }
  gathered.numbers.resize(gathered.begin.back());
  barrier();  // if a process had no memory for it, all fail here instead of waiting
  doGather(mine, counts, gathered.numbers);
  return gathered;
}

void ProcessTeam::showAll(
    std::span<const std::uint64_t> mine,
    const std::function<void(std::uint32_t, std::span<const std::uint64_t>)>& take) {
  const std::vector<std::uint64_t> counts = gatherCounts(mine.size());
  std::vector<std::uint64_t> shown(*std::max_element(counts.begin(), counts.end()));
  for (std::uint32_t r = 0; r < counts.size(); ++r) {
    const std::span<std::uint64_t> numbers = std::span(shown).first(counts[r]);
    if (r == rank()) std::copy(mine.begin(), mine.end(), numbers.begin());
    barrier();  // likewise
    doShare(r, std::as_writable_bytes(numbers));
    take(r, numbers);
  }
}

}  // namespace hexhex
