#include "handle_table.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

#include <hexhex/error.hpp>

#include "guard.hpp"

namespace hexhex::c {

/// One handle. Entries stay for ever, and serve one handle after the other: who finds one may look
/// at it without a lock.
struct HandleEntry {
  std::atomic<const void*> handle{nullptr};  ///< null: free
  std::atomic<Destroyer> kind{nullptr};
  std::atomic<std::uint64_t> users{0};
  HandleEntry* next = nullptr;
};

namespace {

// Users of an entry: numbers of all and of readers, and bits. Nobody uses a doomed one any more but
// those who began before; the last of them marks it as dead, and deletes the handle.
constexpr std::uint64_t kUser = 1;
constexpr std::uint64_t kReader = std::uint64_t{1} << 28;
constexpr std::uint64_t kReaders = ((std::uint64_t{1} << 56) - 1) & ~(kReader - 1);
constexpr std::uint64_t kChanging = std::uint64_t{1} << 60;
constexpr std::uint64_t kDoomed = std::uint64_t{1} << 61;
constexpr std::uint64_t kDead = std::uint64_t{1} << 62;

/// Programs have a few handles; with a hundred thousand of them, finding one takes a microsecond.
constexpr std::size_t kBuckets = 1024;
std::array<std::atomic<HandleEntry*>, kBuckets> table;
static_assert(std::atomic<const void*>::is_always_lock_free &&
              std::atomic<std::uint64_t>::is_always_lock_free);

/// In an entry that is being filled or emptied.
const char kReserved = 0;

std::atomic<HandleEntry*>& bucketOf(const void* handle) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;  // Fibonacci hashing
  constexpr unsigned kShift = 54;
  static_assert(kBuckets == std::size_t{1} << (64 - kShift));
  return table[(reinterpret_cast<std::uintptr_t>(handle) * kGolden) >> kShift];
}

constexpr std::uint64_t partOf(Use use) {
  return use == Use::Look ? 0 : (use == Use::Read ? kReader : kChanging);
}

/// What keeps a use from beginning.
constexpr std::uint64_t obstaclesTo(Use use) {
  return use == Use::Look ? 0 : (use == Use::Read ? kChanging : kChanging | kReaders);
}

/// One user less.
void leave(HandleEntry& entry, std::uint64_t part) noexcept {
  if (entry.users.fetch_sub(part + kUser) - part - kUser != kDoomed) return;
  std::uint64_t doomed = kDoomed;
  if (!entry.users.compare_exchange_strong(doomed, kDead)) return;
  const void* const handle = entry.handle.exchange(&kReserved);
  entry.kind.load()(handle);
  entry.users.fetch_sub(kDead);
  entry.handle.store(nullptr);
}

enum class Found { Good, Missing, OtherKind, InUse };

/// Finds an entry and begins to use it, if it is good.
Found find(const void* handle, Destroyer kind, Use use, HandleEntry*& found) noexcept {
  HandleEntry* entry = bucketOf(handle).load();
  while (entry != nullptr && entry->handle.load() != handle) entry = entry->next;
  if (entry == nullptr || handle == nullptr) return Found::Missing;
  // From here on it is not deleted, and serves no other handle; it may have come to do so before.
  std::uint64_t users = entry->users.fetch_add(kUser) + kUser;
  const auto refuse = [entry](Found why) {
    leave(*entry, 0);
    return why;
  };
  if (entry->handle.load() != handle || (users & (kDoomed | kDead)) != 0) {
    return refuse(Found::Missing);
  }
  if (entry->kind.load() != kind) return refuse(Found::OtherKind);
  do {
    if ((users & kDoomed) != 0) return refuse(Found::Missing);
    if ((users & obstaclesTo(use)) != 0) return refuse(Found::InUse);
  } while (!entry->users.compare_exchange_weak(users, users + partOf(use)));
  found = entry;
  return Found::Good;
}

}  // namespace

void enterHandle(const void* handle, Destroyer kind) {
  std::atomic<HandleEntry*>& bucket = bucketOf(handle);
  for (HandleEntry* entry = bucket.load(); entry != nullptr; entry = entry->next) {
    const void* nothing = nullptr;
    if (!entry->handle.compare_exchange_strong(nothing, &kReserved)) continue;
    entry->kind.store(kind);
    entry->handle.store(handle);
    return;
  }
  auto entry = std::make_unique<HandleEntry>();
  entry->kind.store(kind);
  entry->handle.store(handle);
  entry->next = bucket.load();
  while (!bucket.compare_exchange_weak(entry->next, entry.get())) {
  }
  static_cast<void>(entry.release());
}

HandleEntry* tryUse(const void* handle, Destroyer kind, Use use) noexcept {
  HandleEntry* entry = nullptr;
  static_cast<void>(find(handle, kind, use, entry));
  return entry;
}

HandleEntry& beginUse(const void* handle, Destroyer kind, Use use, const char* argument) {
  if (handle == nullptr) throwNull(argument);
  HandleEntry* entry = nullptr;
  const Found found = find(handle, kind, use, entry);
  if (found == Found::InUse) throwBusy(argument);
  if (found == Found::Good) return *entry;
  throw Error(ErrorCode::InvalidArgument,
              std::string("The argument `") + argument +
                  (found == Found::OtherKind
                       ? "` is a handle of another kind. Give one of the kind that it is for."
                       : "` is no handle: it was destroyed, or never made. Give one that lives."));
}

void endUse(HandleEntry& entry, Use use) noexcept { leave(entry, partOf(use)); }

void destroyHandle(const void* handle, Destroyer kind) noexcept {
  HandleEntry* entry = nullptr;
  if (find(handle, kind, Use::Look, entry) != Found::Good) return;
  entry->users.fetch_or(kDoomed);
  leave(*entry, 0);
}

// Not inline, or compilers would see one half of a pair, and complain about the other.
[[gnu::noinline]] void* RestingMemory::operator new(std::size_t size) {
  return ::operator new(size);
}

[[gnu::noinline]] void RestingMemory::operator delete(void* memory) noexcept {
  constexpr std::size_t kResting = 1024;  // of some hundred bytes each
  static std::array<std::atomic<void*>, kResting> ring;
  static std::atomic<std::size_t> next{0};
  ::operator delete(ring[next.fetch_add(1) % kResting].exchange(memory));
}

}  // namespace hexhex::c
