// SPDX-License-Identifier: MIT
// The seeds of the fuzzers, and every file that once broke something: what must hold for any bytes holds for them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/claims.h"
#include "meshbound/certificate.h"
#include "meshbound/distance.h"

namespace meshbound {
namespace corpus_test {

namespace fs = std::filesystem;

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void replay(const std::string& target, const std::vector<std::uint8_t>& bytes) {
  if (target == "fuzz_distance") return fuzz::check_distance(bytes);
  if (target == "fuzz_certificate") return fuzz::check_certificate(bytes);
  if (target == "fuzz_penetration") return fuzz::check_penetration(bytes);
  if (target == "fuzz_texture") return fuzz::check_texture(bytes);
  if (target == "fuzz_simplify") return fuzz::check_simplify(bytes);
  const std::string reader = "fuzz_read_";
  ASSERT_EQ(target.substr(0, reader.size()), reader) << "a folder of the corpus that no target belongs to";
  fuzz::check_reader("." + target.substr(reader.size()), bytes);
}

/// Replays all files of a folder with one subfolder for each target; returns how many.
int replay_all(const fs::path& corpus) {
  int files = 0;
  for (const fs::directory_entry& target : fs::directory_iterator(corpus)) {
    for (const fs::directory_entry& file : fs::directory_iterator(target.path())) {
      SCOPED_TRACE(file.path().string());
      EXPECT_NO_THROW(replay(target.path().filename().string(), bytes_of(file.path())));
      ++files;
    }
  }
  return files;
}

TEST(Corpus, HasASeedThatIsACertificate) {
  const auto [original, simplified] = fuzz::certificate_pair();
  const double tolerance = 1.01 * hausdorff_distance(Bvh(original), Bvh(simplified)).bounds.upper;
  const auto certificate = build_certificate(original, simplified, tolerance);
  ASSERT_TRUE(certificate);
  std::vector<std::uint8_t> seed = {0};
  seed.insert(seed.end(), certificate->bytes.begin(), certificate->bytes.end());
  EXPECT_NO_THROW(fuzz::check_certificate(seed));
  seed[0] = 1;
  EXPECT_NO_THROW(fuzz::check_certificate(seed));
}

TEST(Corpus, HoldsWhatTheFuzzersCheck) {
  const fs::path tests = fs::path(MESHBOUND_SOURCE_DIR) / "tests";
  EXPECT_GE(replay_all(tests / "fuzz/corpus"), 5) << "the seeds are gone";
  if (fs::exists(tests / "corpus")) replay_all(tests / "corpus");  // absent until something is found
}

}  // namespace corpus_test
}  // namespace meshbound
