// SPDX-License-Identifier: MIT
#pragma once
#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace meshbound::mpi {

/// The ranks of a run, and what they say to one another. Who waits sleeps, so that ranks that share a processor do not
/// take it from those that work. All members but `rank`, `size` and the counters are for the thread that initialised
/// MPI, and all but the messages between two ranks must be called by all ranks in the same order.
class Communicator {
 public:
  /// Uses a copy of `ranks`, so that no message of the caller can be mistaken for one of these.
  explicit Communicator(MPI_Comm ranks);
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  /// Those of these ranks that share a machine with this one, in the same order.
  [[nodiscard]] Communicator on_this_machine() const;

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  /// Gives all ranks the bytes of `root`.
  void broadcast(std::string& bytes, int root);
  /// Gives all ranks the `size` bytes of `root`; all ranks know the size.
  void broadcast(char* bytes, std::size_t size, int root);
  /// The bytes of each rank, by rank, on all of them.
  [[nodiscard]] std::vector<std::string> all_gather(std::string bytes);
  /// The bytes of each rank, by rank, on rank 0; nothing on the others.
  [[nodiscard]] std::vector<std::string> gather(std::string bytes);
  [[nodiscard]] bool any(bool here);
  /// The sum over all ranks.
  [[nodiscard]] std::uint64_t sum(std::uint64_t here);
  /// Where `error` is not null on some rank, all ranks throw that of the first one: its kind where it is one of this
  /// library's or out of memory, else `Error`.
  void throw_together(const std::exception_ptr& error);
  /// All ranks do the step, and throw together what it throws on one of them.
  void do_together(const std::function<void()>& step);
  /// Whether `throw_together` has thrown since `begin_together`: all ranks have left what they did, and none waits for
  /// another.
  void begin_together() { has_thrown_together_ = false; }
  [[nodiscard]] bool has_thrown_together() const { return has_thrown_together_; }

  /// Sends one number to another rank.
  void send(std::int64_t number, int to, int tag);
  struct Message {
    int from = 0;
    std::int64_t number = 0;
  };
  /// A number that has come with this tag, if one has.
  [[nodiscard]] std::optional<Message> receive(int tag);

  /// Bytes that this rank has sent here and in groups made of this one, each as often as there are receivers.
  [[nodiscard]] std::uint64_t bytes_sent() const { return *bytes_sent_; }

 private:
  /// Takes the group over.
  struct Owned {
    MPI_Comm ranks;
  };
  Communicator(Owned ranks, std::shared_ptr<std::uint64_t> bytes_sent);
  void start_broadcast(char* bytes, std::size_t size, int root, std::vector<MPI_Request>& under_way);
  void send(const std::string& bytes, int to);
  [[nodiscard]] std::string receive_from(int from);

  MPI_Comm ranks_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  bool has_thrown_together_ = false;
  std::shared_ptr<std::uint64_t> bytes_sent_;
};

/// Sleeps for about half a millisecond.
void rest();

}  // namespace meshbound::mpi
