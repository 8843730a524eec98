// SPDX-License-Identifier: MIT
// mpirun -n N tiles_over_ranks CASE: what tests/mpi_test.cpp says of the library over ranks. Ends with 0 where it holds
// on every rank; a rank where it does not says so on stderr.
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "mesh/readers.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/mpi.h"
#include "mpi/rank_runner.h"
#include "mpi/read_shares.h"

namespace meshbound {
namespace {

int rank = 0;
bool has_failed = false;

void expect(bool holds, const char* what) {
  if (holds) return;
  has_failed = true;
  std::fprintf(stderr, "rank %d: %s does not hold\n", rank, what);
}

bool are_same(const OneSidedDistance& a, const OneSidedDistance& b) {
  return a.bounds.lower == b.bounds.lower && a.bounds.upper == b.bounds.upper &&
         a.witness.from.position == b.witness.from.position && a.witness.from.triangle == b.witness.from.triangle &&
         a.witness.nearest.position == b.witness.nearest.position && a.outcome == b.outcome &&
         a.stats.triangles == b.stats.triangles && a.stats.pieces == b.stats.pieces &&
         a.stats.closest_point_queries == b.stats.closest_point_queries;
}

void simplify() {
  for (const TriangleMesh& mesh : {datasets::terrain(1, 60, 7), datasets::mesh_of_size("uv-sphere", 4000)}) {
    SimplifyOptions options;
    options.tolerance = 0.001 * bounding_box_diagonal(mesh);
    options.threads = 1 + rank % 2;
    const TileOptions tiles{300};
    const SimplifiedLevel over_ranks = mpi::simplify_in_tiles(mesh, options, MPI_COMM_WORLD, tiles).last();
    const SimplifiedLevel alone = simplify_in_tiles(mesh, options, tiles).last();
    expect(over_ranks.mesh.vertices == alone.mesh.vertices, "the same vertices");
    expect(over_ranks.mesh.triangles == alone.mesh.triangles, "the same triangles");
    expect(over_ranks.source_vertex == alone.source_vertex, "the same sources");
    expect(over_ranks.collapses_refused == alone.collapses_refused, "the same counts");
    expect(over_ranks.verdict == Verdict::Within, "within the tolerance");
    expect(are_same(over_ranks.distance->a_to_b, alone.distance->a_to_b), "the same distance");
  }
}

void measure() {
  const TriangleMesh torus = datasets::torus(1, 0.3, 120, 48);
  TriangleMesh moved = torus;
  for (Eigen::Vector3d& p : moved.vertices) p += Eigen::Vector3d(0.01, 0.02, 0.003 * p.x());
  const TileOptions tiles{200};
  const HausdorffDistance over_ranks = mpi::hausdorff_distance_in_tiles(torus, moved, MPI_COMM_WORLD, {}, tiles);
  const HausdorffDistance alone = hausdorff_distance_in_tiles(torus, moved, {}, tiles);
  expect(are_same(over_ranks.a_to_b, alone.a_to_b) && are_same(over_ranks.b_to_a, alone.b_to_a), "the same distance");
  const OneSidedDistance one = mpi::one_sided_hausdorff_distance_in_tiles(torus, moved, MPI_COMM_WORLD, {}, tiles);
  expect(are_same(one, one_sided_hausdorff_distance_in_tiles(torus, moved, {}, tiles)), "the same one-sided distance");
}

/// The file is the second word of the command line.
void read(const std::string& path) {
  const MeshFile together = mpi::read_mesh(path, MPI_COMM_WORLD), alone = read_mesh(path);
  expect(together.mesh.vertices == alone.mesh.vertices && together.mesh.triangles == alone.mesh.triangles,
         "the same mesh");
  try {
    (void)mpi::read_mesh(path + ".not.ply", MPI_COMM_WORLD);
    expect(false, "an exception for a file that is not there");
  } catch (const IoError&) {
  }
}

/// What is read, on rank 0 with what else a file tells, or why nothing is.
template <class Read>
std::string outcome(const Read& read) {
  try {
    MeshInSpace mesh({std::filesystem::temp_directory_path()});
    const MeshFile file = read(mesh);
    std::string text;
    mesh.for_each_vertex([&](std::uint32_t, const Eigen::Vector3d& p) {
      text.append(reinterpret_cast<const char*>(p.data()), sizeof p);
    });
    mesh.for_each_triangle(
        [&](std::uint32_t, const Triangle& t) { text.append(reinterpret_cast<const char*>(t.data()), sizeof t); });
    if (rank != 0) return text;
    for (const std::size_t count : {file.triangulated_polygons, file.ignored_elements, file.dropped.normals,
                                    file.dropped.facet_attributes, file.dropped.colours, file.dropped.other_properties})
      text += ' ' + std::to_string(count);
    return text;
  } catch (const Error& error) {
    return error.what();
  }
}

/// Whether ranks read shares of this file, and that they find what one process does.
void read_into_one_copy(const std::string& path, bool in_shares) {
  mpi::Communicator ranks(MPI_COMM_WORLD);
  std::string bytes_seen;
  FileWindow::Reader reader;
  if (rank == 0) reader = [&](std::string_view bytes) { bytes_seen += bytes; };
  const std::string alone = outcome([&](MeshInSpace& into) { return meshbound::read_mesh_into(path, {}, into); });
  const std::string together =
      outcome([&](MeshInSpace& into) { return mpi::read_mesh_into(ranks, path, {}, into, reader); });
  expect(together == alone, "the same mesh, or the same error");
  const FileShare share{static_cast<std::size_t>(ranks.rank()), static_cast<std::size_t>(ranks.size())};
  MeshInSpace own({std::filesystem::temp_directory_path()});
  const bool has_shares = counts_for_shares(path, {}) && read_share(path, share, {}, own);
  expect(ranks.any(!has_shares) != in_shares, "that ranks read shares");
  if (in_shares && rank == 0) expect(bytes_seen.size() == std::filesystem::file_size(path), "that all bytes are seen");
}

/// Writes next to what one process writes. The folder is the second word of the command line.
void write(const std::filesystem::path& folder) {
  const TriangleMesh mesh = datasets::mesh_of_size("uv-sphere", 3000);
  const auto content = [](const std::filesystem::path& path) { return std::string(FileBytes(path).bytes()); };
  WriteOptions plain, floats, text;
  floats.single_precision = true;
  text.ascii = true;
  for (const std::string name : {"mesh.ply", "mesh.stl", "mesh.obj"})
    for (const WriteOptions& options : {plain, floats, text}) {
      mpi::write_mesh(folder / name, mesh, MPI_COMM_WORLD, options);
      if (rank != 0) continue;
      write_mesh(folder / ("alone-" + name), mesh, options);
      expect(content(folder / name) == content(folder / ("alone-" + name)), "the same bytes");
    }
  try {
    mpi::write_mesh(folder / "not there" / "mesh.ply", mesh, MPI_COMM_WORLD);
    expect(false, "an exception for a folder that is not there");
  } catch (const IoError&) {
  }
}

/// Jobs that note who has done them. One of them throws, if any.
class CountedJobs : public TileJobs {
 public:
  explicit CountedJobs(std::size_t size, std::size_t failing) : done_by_(size, -1), failing_(failing) {}
  [[nodiscard]] std::size_t size() const override { return done_by_.size(); }
  [[nodiscard]] std::uint64_t weight(std::size_t job) const override { return job + 1; }
  void run(std::size_t job) override {
    if (job == failing_) throw InvalidInput("job " + std::to_string(job));
    ++runs_;
    done_by_[job] = rank;
  }
  [[nodiscard]] std::string run_packed(std::size_t job) override {
    run(job);
    return std::to_string(done_by_[job]);
  }
  void unpack(std::size_t job, std::string_view bytes) override { done_by_[job] = std::stoi(std::string(bytes)); }
  [[nodiscard]] bool is_complete(std::size_t) const override { return true; }
  void progress(double) override {}

  [[nodiscard]] std::uint64_t runs() const { return runs_; }
  [[nodiscard]] const std::vector<int>& done_by() const { return done_by_; }

 private:
  std::vector<int> done_by_;
  std::size_t failing_;
  std::atomic<std::uint64_t> runs_ = 0;
};

constexpr std::size_t none_fails = ~std::size_t{0};

void hand_out() {
  mpi::Communicator ranks(MPI_COMM_WORLD);
  for (const std::size_t size : {0, 1, 2, 100}) {
    CountedJobs jobs(size, none_fails);
    mpi::RankRunner(ranks, 2).run(jobs);
    expect(ranks.sum(jobs.runs()) == size, "that each job is run once");
    for (std::size_t job = 0; job < size; ++job) {
      const int by = jobs.done_by()[job];
      expect(by >= 0 && by < ranks.size(), "that each rank has each result");
      expect(ranks.sum(static_cast<std::uint64_t>(by)) ==
                 static_cast<std::uint64_t>(by) * static_cast<std::uint64_t>(ranks.size()),
             "the same result on all ranks");
    }
  }
}

void fail() {
  mpi::Communicator ranks(MPI_COMM_WORLD);
  for (const std::size_t failing : {0, 7, 49}) {
    CountedJobs jobs(50, failing);
    std::string said;
    try {
      mpi::RankRunner(ranks, 1).run(jobs);
    } catch (const InvalidInput& error) {
      said = error.what();
    }
    expect(said == "job " + std::to_string(failing), "that every rank throws what one has thrown");
    expect(ranks.has_thrown_together(), "that all ranks know of it");
  }
  CountedJobs more(5, none_fails);
  mpi::RankRunner(ranks, 1).run(more);
  expect(ranks.sum(more.runs()) == 5, "that ranks go on after an error");
}

/// Rank 0 tells the progress, and its exception ends the run on all ranks.
void fail_in_progress() {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 40);
  int calls = 0, failing = 0;
  const auto progress = [&](double) {
    if (++calls == failing) throw InvalidInput("no more");
  };
  SimplifyOptions simplification;
  simplification.tolerance = 0.02;
  simplification.threads = 2;
  simplification.progress = progress;
  DistanceOptions distance;
  distance.progress = progress;
  const auto said = [&](int call, const auto& work) {
    calls = 0;
    failing = call;
    try {
      work();
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const TileOptions tiles{800};
  const auto simplify = [&] { (void)mpi::simplify_in_tiles(torus, simplification, MPI_COMM_WORLD, tiles); };
  const auto measure = [&] { (void)mpi::hausdorff_distance_in_tiles(torus, torus, MPI_COMM_WORLD, distance, tiles); };
  for (const int call : {1, 3}) {
    expect(said(call, simplify) == "no more", "that every rank throws what the progress of one has thrown");
    expect(said(call, measure) == "no more", "that every rank throws what the progress of one has thrown");
  }
  expect(said(0, simplify).empty() && said(0, measure).empty(), "that ranks go on after an error");
}

}  // namespace
}  // namespace meshbound

int main(int argc, char** argv) {
  using namespace meshbound;
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const std::string test_case = argc > 1 ? argv[1] : "";
  if (test_case == "simplify") simplify();
  if (test_case == "measure") measure();
  if (test_case == "read" && argc > 2) read(argv[2]);
  if (test_case == "read-shares" && argc > 2) read_into_one_copy(argv[2], true);
  if (test_case == "read-whole" && argc > 2) read_into_one_copy(argv[2], false);
  if (test_case == "write" && argc > 2) write(argv[2]);
  if (test_case == "hand-out") hand_out();
  if (test_case == "fail") fail();
  if (test_case == "fail-in-progress") fail_in_progress();
  MPI_Finalize();
  return has_failed ? 1 : 0;
}
