// SPDX-License-Identifier: MIT
#include "mesh/temporary_files.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>

#include "meshbound/error.h"

namespace meshbound {

/// A signal handler may neither lock nor allocate. So entries are reused but never freed, and a name counts only once
/// it is complete.
struct TemporaryEntry {
  enum class State { Free, Filling, Listed };
  std::atomic<State> state = State::Filling;
  std::array<char, PATH_MAX> name{};
  TemporaryEntry* next = nullptr;  ///< constant once the entry is in the list
};
static_assert(std::atomic<TemporaryEntry::State>::is_always_lock_free &&
              std::atomic<TemporaryEntry*>::is_always_lock_free);

namespace {

std::atomic<TemporaryEntry*> first_entry = nullptr;

TemporaryEntry* free_entry() {
  for (TemporaryEntry* entry = first_entry; entry != nullptr; entry = entry->next) {
    TemporaryEntry::State expected = TemporaryEntry::State::Free;
    if (entry->state.compare_exchange_strong(expected, TemporaryEntry::State::Filling)) return entry;
  }
  TemporaryEntry* const entry = new TemporaryEntry;  // reachable from the list for the rest of the process
  entry->next = first_entry;
  while (!first_entry.compare_exchange_weak(entry->next, entry)) {
  }
  return entry;
}

}  // namespace

TemporaryName::TemporaryName(const std::filesystem::path& path) {
  const std::string& name = path.native();
  if (name.size() >= PATH_MAX) throw IoError(name + ": the path is too long");
  entry_ = free_entry();
  std::memcpy(entry_->name.data(), name.c_str(), name.size() + 1);
  entry_->state = TemporaryEntry::State::Listed;
}

TemporaryName::~TemporaryName() { entry_->state = TemporaryEntry::State::Free; }

void remove_temporary_files() noexcept {
  const auto for_all = [](int (*remove)(const char*)) {
    for (TemporaryEntry* entry = first_entry; entry != nullptr; entry = entry->next)
      if (entry->state == TemporaryEntry::State::Listed) remove(entry->name.data());
  };
  for_all(::unlink);
  for_all(::rmdir);  // succeeds for what is an empty folder by now
}

}  // namespace meshbound
