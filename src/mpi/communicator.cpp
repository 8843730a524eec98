// SPDX-License-Identifier: MIT
#include "mpi/communicator.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>
#include <thread>

#include "meshbound/error.h"
#include "meshbound/stop_token.h"
#include "tiles/compact_bytes.h"

namespace meshbound::mpi {
namespace {

/// Bytes of the largest message: MPI counts in ints.
constexpr std::size_t max_message = std::size_t{1} << 30;

/// Waits asleep for a message that may be long in coming.
void wait_asleep(MPI_Request& request) {
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    rest();
  }
}

/// Waits for a transfer that is under way, which only advances while both sides look at it.
void wait_awake(MPI_Request& request) {
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    ::sched_yield();
  }
}

enum class Kind : std::uint64_t { Error, InvalidInput, IoError, Interrupted, Stopped, OutOfMemory };

std::string described(const std::exception_ptr& error) {
  CompactWriter to;
  const auto write = [&](Kind kind, std::string_view what) {
    to.number(static_cast<std::uint64_t>(kind));
    to.text(what);
  };
  try {
    std::rethrow_exception(error);
  } catch (const InvalidInput& e) {
    write(Kind::InvalidInput, e.what());
  } catch (const IoError& e) {
    write(Kind::IoError, e.what());
  } catch (const Interrupted& e) {
    write(Kind::Interrupted, e.what());
  } catch (const Stopped& e) {
    write(Kind::Stopped, e.what());
  } catch (const std::bad_alloc&) {
    write(Kind::OutOfMemory, "");
  } catch (const std::exception& e) {
    write(Kind::Error, e.what());
  }
  return to.take();
}

[[noreturn]] void throw_described(std::string_view bytes) {
  CompactReader from(bytes);
  const auto kind = static_cast<Kind>(from.number());
  const std::string what(from.text());
  switch (kind) {
    case Kind::InvalidInput:
      throw InvalidInput(what);
    case Kind::IoError:
      throw IoError(what);
    case Kind::Interrupted:
      throw Interrupted(what);
    case Kind::Stopped:
      throw Stopped(what);
    case Kind::OutOfMemory:
      throw std::bad_alloc();
    case Kind::Error:
      break;
  }
  throw Error(what);
}

}  // namespace

void rest() { std::this_thread::sleep_for(std::chrono::microseconds(500)); }

Communicator::Communicator(MPI_Comm ranks) {
  MPI_Comm_dup(ranks, &ranks_);
  MPI_Comm_rank(ranks_, &rank_);
  MPI_Comm_size(ranks_, &size_);
}

Communicator::~Communicator() { MPI_Comm_free(&ranks_); }

void Communicator::broadcast(std::string& bytes, int root) {
  std::uint64_t size = bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, root, ranks_, &request);
  wait_asleep(request);
  if (rank_ == root) bytes_sent_ += sizeof size * static_cast<std::uint64_t>(size_ - 1);
  bytes.resize(size);
  broadcast(bytes.data(), bytes.size(), root);
}

void Communicator::broadcast(char* bytes, std::size_t size, int root) {
  for (std::size_t first = 0; first < size; first += max_message) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(bytes + first, static_cast<int>(std::min(max_message, size - first)), MPI_BYTE, root, ranks_, &request);
    wait_awake(request);
  }
  if (rank_ == root) bytes_sent_ += size * static_cast<std::uint64_t>(size_ - 1);
}

std::vector<std::string> Communicator::all_gather(std::string bytes) {
  std::vector<std::string> all(static_cast<std::size_t>(size_));
  all[static_cast<std::size_t>(rank_)] = std::move(bytes);
  for (int root = 0; root < size_; ++root) broadcast(all[static_cast<std::size_t>(root)], root);
  return all;
}

bool Communicator::any(bool here) {
  int own = here ? 1 : 0, whole = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&own, &whole, 1, MPI_INT, MPI_MAX, ranks_, &request);
  wait_asleep(request);
  bytes_sent_ += size_ > 1 ? sizeof own : 0;
  return whole != 0;
}

std::uint64_t Communicator::sum(std::uint64_t here) {
  std::uint64_t whole = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&here, &whole, 1, MPI_UINT64_T, MPI_SUM, ranks_, &request);
  wait_asleep(request);
  return whole;
}

void Communicator::throw_together(const std::exception_ptr& error) {
  int own = error ? rank_ : std::numeric_limits<int>::max(), first = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&own, &first, 1, MPI_INT, MPI_MIN, ranks_, &request);
  wait_asleep(request);
  bytes_sent_ += size_ > 1 ? sizeof own : 0;
  if (first == std::numeric_limits<int>::max()) return;
  std::string bytes = first == rank_ ? described(error) : std::string();
  broadcast(bytes, first);
  has_thrown_together_ = true;
  throw_described(bytes);
}

void Communicator::send(std::int64_t number, int to, int tag) {
  MPI_Send(&number, 1, MPI_INT64_T, to, tag, ranks_);  // so small that it is on its way at once
  bytes_sent_ += sizeof number;
}

std::optional<Communicator::Message> Communicator::receive(int tag) {
  int has_come = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, tag, ranks_, &has_come, &status);
  if (has_come == 0) return std::nullopt;
  Message message{status.MPI_SOURCE, 0};
  MPI_Recv(&message.number, 1, MPI_INT64_T, message.from, tag, ranks_, MPI_STATUS_IGNORE);
  return message;
}

}  // namespace meshbound::mpi
