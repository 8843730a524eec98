// SPDX-License-Identifier: MIT
// mpirun -n N bench_ranks: how a run over many ranks spends its time. Rank 0 simplifies and measures a mesh in tiles
// and records the processor time and the result of each tile. Then all ranks do as many such tiles as asked: they sleep
// as long as a tile took, and send its real bytes by the real exchange. So far more ranks than processors can be looked
// at.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/mesh_summary.h"
#include "mpi/rank_runner.h"
#include "processor_time.h"
#include "tiles/compact_bytes.h"
#include "tiles/decimate_in_tiles.h"
#include "tiles/tile_jobs.h"

namespace {

using namespace meshbound;

double processor_seconds() { return bench::processor_seconds(CLOCK_THREAD_CPUTIME_ID); }

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One tile in one pass, or in a measurement.
struct RecordedJob {
  std::uint64_t weight = 0;
  double work = 0, unpacking = 0;  ///< processor seconds
  std::string bytes;
};

/// A pass or a measurement.
using RecordedStep = std::vector<RecordedJob>;

struct Recording {
  std::vector<RecordedStep> steps;
  double together = 0;  ///< processor seconds of what every rank does for itself
};

/// Does all jobs in this thread, and puts each back from its bytes as another process would.
class Recorder : public JobRunner {
 public:
  void run(TileJobs& jobs) override {
    RecordedStep& step = recording_.steps.emplace_back(jobs.size());
    for (const std::size_t job : heaviest_first(jobs)) {
      const double begin = processor_seconds();
      std::string bytes = jobs.run_packed(job);
      const double packed = processor_seconds();
      jobs.unpack(job, bytes);
      step[job] = {jobs.weight(job), packed - begin, processor_seconds() - packed, std::move(bytes)};
    }
  }
  void do_together(const std::function<void()>& step) override {
    const double begin = processor_seconds();
    step();
    recording_.together += processor_seconds() - begin;
  }
  [[nodiscard]] const Recording& recording() const { return recording_; }

 private:
  Recording recording_;
};

std::string packed(const Recording& recording) {
  CompactWriter to;
  to.raw(recording.together);
  to.number(recording.steps.size());
  for (const RecordedStep& step : recording.steps) {
    to.number(step.size());
    for (const RecordedJob& job : step) {
      to.number(job.weight);
      to.raw(job.work);
      to.raw(job.unpacking);
      to.text(job.bytes);
    }
  }
  return to.take();
}

Recording unpacked(std::string_view bytes) {
  CompactReader from(bytes);
  Recording recording;
  from.raw(recording.together);
  recording.steps.resize(from.number());
  for (RecordedStep& step : recording.steps) {
    step.resize(from.number());
    for (RecordedJob& job : step) {
      job.weight = from.number();
      from.raw(job.work);
      from.raw(job.unpacking);
      job.bytes = from.text();
    }
  }
  return recording;
}

/// Copies of the jobs of a step, which sleep `pace` times as long as these took.
class SleepingJobs : public TileJobs {
 public:
  SleepingJobs(const RecordedStep& step, std::size_t copies, double pace)
      : step_(step), size_(copies * step.size()), pace_(pace) {}
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] std::uint64_t weight(std::size_t job) const override { return recorded(job).weight; }
  void run(std::size_t job) override { (void)run_packed(job); }
  [[nodiscard]] std::string run_packed(std::size_t job) override {
    sleep(recorded(job).work);
    work_ += pace_ * recorded(job).work;
    last_end_ = seconds_now();
    return recorded(job).bytes;
  }
  void unpack(std::size_t job, std::string_view bytes) override {
    if (first_unpack_ == 0) first_unpack_ = seconds_now();
    if (bytes != recorded(job).bytes) throw std::runtime_error("a result came with other bytes than it has");
    sleep(recorded(job).unpacking);
  }
  [[nodiscard]] bool is_complete(std::size_t) const override { return true; }
  void progress(double) override {}

  [[nodiscard]] double work() const { return work_; }
  [[nodiscard]] double last_end() const { return last_end_; }
  [[nodiscard]] double first_unpack() const { return first_unpack_; }

 private:
  [[nodiscard]] const RecordedJob& recorded(std::size_t job) const { return step_[job % step_.size()]; }
  void sleep(double seconds) const { std::this_thread::sleep_for(std::chrono::duration<double>(pace_ * seconds)); }

  const RecordedStep& step_;
  std::size_t size_;
  double pace_;
  double work_ = 0, last_end_ = 0, first_unpack_ = 0;  // of one thread that works
};

/// What all ranks together did in the steps so far; seconds as they were slept.
struct Totals {
  std::size_t jobs = 0;
  double work = 0;      ///< of all ranks
  double handing = 0;   ///< from the first job to the last one's end
  double exchange = 0;  ///< from there until the first rank had all results
  double unpacking = 0;
  double first_rank = 0;  ///< processor seconds of the thread of rank 0 that hands out jobs and sends
};

double reduced(double here, MPI_Op how) {
  double all = 0;
  MPI_Allreduce(&here, &all, 1, MPI_DOUBLE, how, MPI_COMM_WORLD);
  return all;
}

void run_step(const RecordedStep& step, std::size_t copies, double pace, mpi::Communicator& ranks, Totals& totals) {
  SleepingJobs jobs(step, copies, pace);
  MPI_Barrier(MPI_COMM_WORLD);
  const double begin = seconds_now(), processor = processor_seconds();
  mpi::RankRunner(ranks, 1).run(jobs);
  totals.first_rank += processor_seconds() - processor;
  const double end = reduced(seconds_now(), MPI_MAX), last_end = reduced(jobs.last_end(), MPI_MAX);
  const double unpacks_from = std::max(last_end, reduced(jobs.first_unpack() > 0 ? jobs.first_unpack() : end, MPI_MIN));
  totals.jobs += jobs.size();
  totals.work += reduced(jobs.work(), MPI_SUM);
  totals.handing += last_end - reduced(begin, MPI_MIN);
  totals.exchange += unpacks_from - last_end;
  totals.unpacking += end - unpacks_from;
}

/// Seconds of a run by what was recorded of `recorded_triangles`, for one thread a rank, without sending.
void print_expected(const Recording& recording, std::size_t recorded_triangles, double triangles) {
  double work = 0, unpacking = 0, longest = 0;
  std::size_t bytes = 0;
  for (const RecordedStep& step : recording.steps) {
    double longest_of_step = 0;
    for (const RecordedJob& job : step) {
      work += job.work;
      unpacking += job.unpacking;
      bytes += job.bytes.size();
      longest_of_step = std::max(longest_of_step, job.work);
    }
    longest += longest_of_step;
  }
  const auto of = static_cast<double>(recorded_triangles);
  std::printf(
      "for each triangle: work %.2f us, unpacking of results %.3f us, what each rank does for itself %.3f us, "
      "results %.3f bytes\n",
      1e6 * work / of, 1e6 * unpacking / of, 1e6 * recording.together / of, static_cast<double>(bytes) / of);
  std::printf("expected of %.3g triangles, one thread a rank, in seconds without sending:\n", triangles);
  std::printf("%8s %12s %12s %12s %12s %12s %18s\n", "ranks", "work", "last jobs", "unpacking", "for itself", "sum",
              "bytes to a rank");
  const double scale = triangles / of;
  for (const int ranks : {1, 10, 100, 1000}) {
    const double others = 1 - 1.0 / ranks, last = ranks > 1 ? longest : 0;
    const double each[] = {scale * work / ranks, last, scale * unpacking * others, scale * recording.together};
    std::printf("%8d %12.0f %12.0f %12.0f %12.0f %12.0f %18.3g\n", ranks, each[0], each[1], each[2], each[3],
                each[0] + each[1] + each[2] + each[3], scale * static_cast<double>(bytes) * others);
  }
}

struct Options {
  std::string kind = "torus";
  std::size_t size = 2'000'000;
  double tolerance = 0.001;  ///< of the diagonal
  std::size_t tile_triangles = TileOptions().max_triangles;
  std::size_t tiles_per_rank = 4;
  double pace = 0.1;
  double triangles = 1e10;
};

Options parsed(int argc, char** argv) {
  Options options;
  CLI::App app("Looks at a run over more ranks than there are processors: mpirun -n N bench_ranks", "bench_ranks");
  app.add_option("--mesh", options.kind, "Kind of mesh, as those of generate_mesh")->capture_default_str();
  app.add_option("--size", options.size, "Its triangles")->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "Share of the diagonal")->capture_default_str();
  app.add_option("--tile-triangles", options.tile_triangles, "Triangles of a tile")->capture_default_str();
  app.add_option("--tiles-per-rank", options.tiles_per_rank, "Tiles of a pass for each rank")->capture_default_str();
  app.add_option("--pace", options.pace, "Share of its time that a tile is slept for")->capture_default_str();
  app.add_option("--triangles", options.triangles, "Triangles of the run to expect")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const int code = rank == 0 ? app.exit(error) : error.get_exit_code();
    MPI_Finalize();
    std::exit(code);
  }
  return options;
}

Recording record(const Options& options, std::size_t& triangles) {
  const TriangleMesh mesh = datasets::mesh_of_size(options.kind, options.size);
  triangles = mesh.triangles.size();
  SimplifyOptions simplify;
  simplify.tolerance = options.tolerance * bounding_box_diagonal(mesh);
  Recorder recorder;
  const SimplifyResult result = simplify_in_tiles(mesh, simplify, {options.tile_triangles}, recorder);
  std::printf("recorded: %s of %zu triangles, %zu faces, %zu steps\n", options.kind.c_str(), triangles,
              result.last().mesh.triangles.size(), recorder.recording().steps.size());
  return recorder.recording();
}

/// Waits with long rests, so that a rank that works is left alone.
void wait_for_all() {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int done = 0; done == 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE))
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

void run(const Options& options) {
  mpi::Communicator ranks(MPI_COMM_WORLD);
  std::size_t triangles = 0;
  std::string bytes = ranks.rank() == 0 ? packed(record(options, triangles)) : std::string();
  wait_for_all();
  ranks.broadcast(bytes, 0);
  const Recording recording = unpacked(bytes);
  const std::size_t tiles = std::max<std::size_t>(recording.steps.at(0).size(), 1);
  const std::size_t wanted = options.tiles_per_rank * static_cast<std::size_t>(ranks.size());
  const std::size_t copies = (wanted + tiles - 1) / tiles;
  const std::uint64_t sent_before = ranks.sum(ranks.bytes_sent());
  Totals totals;
  for (const RecordedStep& step : recording.steps) run_step(step, copies, options.pace, ranks, totals);
  const std::uint64_t sent = ranks.sum(ranks.bytes_sent()) - sent_before;
  if (ranks.rank() != 0) return;
  const auto jobs = static_cast<double>(std::max<std::size_t>(totals.jobs, 1));
  std::printf(
      "%d ranks, %zu jobs: %llu bytes sent; %.3f s of jobs, in which ranks wait for %.1f%% of the time; then "
      "%.3f s of sending and %.3f s of unpacking\n",
      ranks.size(), totals.jobs, static_cast<unsigned long long>(sent), totals.handing,
      100 * (1 - totals.work / (totals.handing * ranks.size())), totals.exchange, totals.unpacking);
  std::printf("rank 0: %.3f ms of its processor for each job\n", 1e3 * totals.first_rank / jobs);
  print_expected(recording, triangles, options.triangles);
}

}  // namespace

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  const Options options = parsed(argc, argv);
  run(options);
  MPI_Finalize();
  return 0;
}
