#include "linalg/mumps_factor.h"

#include <dmumps_c.h>

#include <mutex>
#include <utility>

#include "base/check.h"
#include "linalg/null_pivot.h"
#include "linalg/one_thread.h"

namespace rhexis::linalg {
namespace {

constexpr MUMPS_INT kUseCommWorld = -987654;
enum class Job : MUMPS_INT { start = -1, end = -2, analyse = 1, factor = 2, solve = 3 };

/// MUMPS keeps state of the run in Fortran modules: one call at a time in a process.
std::mutex& mumps_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

struct MumpsFactor::Instance {
  explicit Instance(Kind kind) {
    mumps.par = 1;
    mumps.sym = kind == Kind::symmetric ? 2 : 0;
    mumps.comm_fortran = kUseCommWorld;
    call(Job::start);
    for (const int stream : {1, 2, 3}) icntl(stream) = -1;
    icntl(4) = 0;
    icntl(6) = 0;   // no permutation to a large diagonal: the structure is symmetric and so stays
    icntl(7) = 1;   // the order is ours
    icntl(10) = 0;  // refinement is ours, on the matrix itself
    icntl(12) = 1;  // no compressed graph: every diagonal entry is there
    icntl(13) = 1;  // the root like any front: its inertia is counted
    icntl(24) = 1;  // carry on past null pivots, and count them
  }
  ~Instance() { call(Job::end); }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  void call(Job job) {
    const std::lock_guard lock(mumps_mutex());
    stay_on_one_thread();
    mumps.job = static_cast<MUMPS_INT>(job);
    dmumps_c(&mumps);
  }
  /// Numbered from 1 as in the manual.
  [[nodiscard]] MUMPS_INT& icntl(int number) { return mumps.icntl[number - 1]; }
  [[nodiscard]] MUMPS_INT infog(int number) const { return mumps.infog[number - 1]; }

  [[nodiscard]] MumpsOutcome outcome() const {
    const MUMPS_INT code = infog(1);
    if (code >= 0) return infog(28) > 0 ? MumpsOutcome::singular : MumpsOutcome::ok;
    if (code == -10) return MumpsOutcome::singular;
    const bool memory =
        code == -7 || code == -8 || code == -9 || code == -13 || code == -17 || code == -19 || code == -20;
    RHEXIS_CHECK(memory, "MUMPS says INFOG(1) = {}, INFOG(2) = {}", code, infog(2));
    return MumpsOutcome::out_of_memory;
  }

  DMUMPS_STRUC_C mumps{};
};

MumpsFactor::MumpsFactor(Kind kind) : instance_(std::make_unique<Instance>(kind)) {}
MumpsFactor::~MumpsFactor() = default;
MumpsFactor::MumpsFactor(MumpsFactor&&) noexcept = default;
MumpsFactor& MumpsFactor::operator=(MumpsFactor&&) noexcept = default;

MumpsOutcome MumpsFactor::analyse(std::int32_t size, std::span<const std::int32_t> rows,
                                  std::span<const std::int32_t> columns, std::span<const std::int32_t> place) {
  static_assert(sizeof(MUMPS_INT) == sizeof(std::int32_t));
  DMUMPS_STRUC_C& mumps = instance_->mumps;
  RHEXIS_CHECK(rows.size() == columns.size() && place.size() == static_cast<std::size_t>(size), "{} rows, {} columns",
               rows.size(), columns.size());
  mumps.n = size;
  mumps.cntl[3 - 1] = null_pivot(size);
  mumps.nnz = static_cast<MUMPS_INT8>(rows.size());
  mumps.irn = const_cast<MUMPS_INT*>(rows.data());  // read only
  mumps.jcn = const_cast<MUMPS_INT*>(columns.data());
  mumps.perm_in = const_cast<MUMPS_INT*>(place.data());
  instance_->call(Job::analyse);
  return instance_->outcome();
}

MumpsOutcome MumpsFactor::factor(std::span<const double> values) {
  DMUMPS_STRUC_C& mumps = instance_->mumps;
  RHEXIS_CHECK(static_cast<MUMPS_INT8>(values.size()) == mumps.nnz, "{} values for {} entries", values.size(),
               mumps.nnz);
  mumps.a = const_cast<double*>(values.data());  // read only
  instance_->call(Job::factor);
  // Pivots put off to later fronts make them larger than the analysis foresaw: -8, -9 and -20 ask for more room.
  constexpr MUMPS_INT kMostPercent = 2000;
  for (MUMPS_INT code = instance_->infog(1);
       (code == -8 || code == -9 || code == -20) && instance_->icntl(14) < kMostPercent; code = instance_->infog(1)) {
    instance_->icntl(14) = 2 * instance_->icntl(14) + 20;
    instance_->call(Job::factor);
  }
  return instance_->outcome();
}

void MumpsFactor::solve(VectorX& x) {
  DMUMPS_STRUC_C& mumps = instance_->mumps;
  RHEXIS_CHECK(x.size() == mumps.n, "{} right-hand sides for {} unknowns", x.size(), mumps.n);
  mumps.nrhs = 1;
  mumps.lrhs = mumps.n;
  mumps.rhs = x.data();
  instance_->call(Job::solve);
  RHEXIS_CHECK(instance_->infog(1) >= 0, "MUMPS says INFOG(1) = {}, INFOG(2) = {}", instance_->infog(1),
               instance_->infog(2));
}

int MumpsFactor::negative_pivots() const { return instance_->infog(12); }
int MumpsFactor::null_pivots() const { return instance_->infog(28); }

std::size_t MumpsFactor::memory_bytes() const {
  constexpr std::size_t kMegabyte = 1'000'000;
  return static_cast<std::size_t>(instance_->infog(19)) * kMegabyte;
}

}  // namespace rhexis::linalg
