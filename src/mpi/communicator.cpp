// SPDX-License-Identifier: MIT
#include "mpi/communicator.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>
#include <span>
#include <thread>

#include "meshbound/error.h"
#include "meshbound/stop_token.h"
#include "tiles/compact_bytes.h"

namespace meshbound::mpi {
namespace {

/// Bytes of the largest message: MPI counts in ints.
constexpr std::size_t max_message = std::size_t{1} << 30;

/// The tag of messages that `gather` sends.
constexpr int bytes_tag = 0;

/// Waits asleep for a message that may be long in coming.
void wait_asleep(MPI_Request& request) {
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    rest();
  }
}

/// Waits for transfers that are under way, which only advance while both sides look at them.
void wait_awake(std::span<MPI_Request> requests) {
  for (int done = 0;;) {
    MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
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

MPI_Comm copy_of(MPI_Comm ranks) {
  MPI_Comm copy = MPI_COMM_NULL;
  MPI_Comm_dup(ranks, &copy);
  return copy;
}

}  // namespace

void rest() { std::this_thread::sleep_for(std::chrono::microseconds(500)); }

Communicator::Communicator(MPI_Comm ranks) : Communicator(Owned{copy_of(ranks)}, std::make_shared<std::uint64_t>(0)) {}

Communicator::Communicator(Owned ranks, std::shared_ptr<std::uint64_t> bytes_sent)
    : ranks_(ranks.ranks), bytes_sent_(std::move(bytes_sent)) {
  MPI_Comm_rank(ranks_, &rank_);
  MPI_Comm_size(ranks_, &size_);
}

Communicator::~Communicator() { MPI_Comm_free(&ranks_); }

Communicator Communicator::on_this_machine() const {
  Owned some{MPI_COMM_NULL};
  MPI_Comm_split_type(ranks_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &some.ranks);
  return Communicator(some, bytes_sent_);
}

void Communicator::broadcast(std::string& bytes, int root) {
  std::uint64_t size = bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, root, ranks_, &request);
  wait_asleep(request);
  if (rank_ == root) *bytes_sent_ += sizeof size * static_cast<std::uint64_t>(size_ - 1);
  bytes.resize(size);
  broadcast(bytes.data(), bytes.size(), root);
}

void Communicator::start_broadcast(char* bytes, std::size_t size, int root, std::vector<MPI_Request>& under_way) {
  for (std::size_t first = 0; first < size; first += max_message)
    MPI_Ibcast(bytes + first, static_cast<int>(std::min(max_message, size - first)), MPI_BYTE, root, ranks_,
               &under_way.emplace_back(MPI_REQUEST_NULL));
}

void Communicator::broadcast(char* bytes, std::size_t size, int root) {
  std::vector<MPI_Request> under_way;
  start_broadcast(bytes, size, root, under_way);
  wait_awake(under_way);
  if (rank_ == root) *bytes_sent_ += size * static_cast<std::uint64_t>(size_ - 1);
}

std::vector<std::string> Communicator::all_gather(std::string bytes) {
  std::vector<std::string> all(static_cast<std::size_t>(size_));
  const std::uint64_t own = bytes.size();
  std::vector<std::uint64_t> sizes(all.size());
  MPI_Request sized = MPI_REQUEST_NULL;
  MPI_Iallgather(&own, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, ranks_, &sized);
  wait_asleep(sized);
  all[static_cast<std::size_t>(rank_)] = std::move(bytes);
  std::vector<MPI_Request> under_way;
  for (int root = 0; root < size_; ++root) {
    std::string& of_root = all[static_cast<std::size_t>(root)];
    of_root.resize(sizes[static_cast<std::size_t>(root)]);
    start_broadcast(of_root.data(), of_root.size(), root, under_way);
  }
  wait_awake(under_way);
  *bytes_sent_ += (sizeof own + own) * static_cast<std::uint64_t>(size_ - 1);
  return all;
}

std::vector<std::string> Communicator::gather(std::string bytes) {
  if (rank_ != 0) {
    send(bytes, 0);
    return {};
  }
  std::vector<std::string> all{std::move(bytes)};
  for (int rank = 1; rank < size_; ++rank) all.push_back(receive_from(rank));
  return all;
}

void Communicator::send(const std::string& bytes, int to) {
  send(static_cast<std::int64_t>(bytes.size()), to, bytes_tag);
  for (std::size_t first = 0; first < bytes.size(); first += max_message) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(bytes.data() + first, static_cast<int>(std::min(max_message, bytes.size() - first)), MPI_BYTE, to,
              bytes_tag, ranks_, &request);
    wait_asleep(request);
  }
  *bytes_sent_ += bytes.size();
}

std::string Communicator::receive_from(int from) {
  std::int64_t size = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(&size, 1, MPI_INT64_T, from, bytes_tag, ranks_, &request);
  wait_asleep(request);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  for (std::size_t first = 0; first < bytes.size(); first += max_message) {
    MPI_Irecv(bytes.data() + first, static_cast<int>(std::min(max_message, bytes.size() - first)), MPI_BYTE, from,
              bytes_tag, ranks_, &request);
    wait_awake({&request, 1});
  }
  return bytes;
}

bool Communicator::any(bool here) {
  int own = here ? 1 : 0, whole = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&own, &whole, 1, MPI_INT, MPI_MAX, ranks_, &request);
  wait_asleep(request);
  *bytes_sent_ += size_ > 1 ? sizeof own : 0;
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
  *bytes_sent_ += size_ > 1 ? sizeof own : 0;
  if (first == std::numeric_limits<int>::max()) return;
  std::string bytes = first == rank_ ? described(error) : std::string();
  broadcast(bytes, first);
  has_thrown_together_ = true;
  throw_described(bytes);
}

void Communicator::do_together(const std::function<void()>& step) {
  std::exception_ptr error;
  try {
    step();
  } catch (...) {
    error = std::current_exception();
  }
  throw_together(error);
}

void Communicator::send(std::int64_t number, int to, int tag) {
  MPI_Send(&number, 1, MPI_INT64_T, to, tag, ranks_);  // so small that it is on its way at once
  *bytes_sent_ += sizeof number;
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
