#include <cstdlib>

#include "tests/session/random_pull.h"
#include "tests/support/measured.h"

namespace rhexis::session {
namespace {

/// RHEXIS_PULLS asks for more; the first of them are run always.
int pull_count() {
  const char* asked = std::getenv("RHEXIS_PULLS");
  return asked != nullptr ? std::atoi(asked) : 200;
}

/// One in four pulls is also held against the full refactorisation at each topology that it draws.
TEST(RandomPulls, TearWithoutHarmAndWithTheForceOfTheTornBody) {
  test::PullTally tally;
  const char* first = std::getenv("RHEXIS_FIRST_PULL");
  const int from = first != nullptr ? std::atoi(first) : 0;
  const int count = pull_count();
  for (int seed = from; seed < from + count; ++seed) {
    test::RandomPull(static_cast<std::uint64_t>(seed)).run(tally, 0.1);
    if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
  }
  test::measured("{} random pulls, {} advances (at most {} in one), {} fell apart", tally.pulls, tally.advances,
                 tally.most_advances, tally.fell_apart);
  test::measured("{} topologies against full refactorisation: stiffness {:.1e}, local boundary {:.1e} at worst",
                 tally.topologies_checked, tally.worst_stiffness, tally.worst_move);
  test::measured("flattest changed tet: {:.3f} of the intact worst (bound {})", tally.worst_ratio,
                 fracture::kFlattestTet);
  test::measured("keep-nodes: {} hinges in {} of {} pulls", tally.hinges, tally.hinged, tally.kept);
  EXPECT_GT(tally.advances, count);  // the sweep tears, it does not only pull
  EXPECT_GT(tally.topologies_checked, count / 10);
}

}  // namespace
}  // namespace rhexis::session
