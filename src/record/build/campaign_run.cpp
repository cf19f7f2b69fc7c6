#include "record/build/campaign_run.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "record/build/part_file.h"
#include "record/store/record_reader.h"
#include "record/store/record_writer.h"

namespace rhexis::record::build {
namespace fs = std::filesystem;
namespace {

/// In the folder of the parts: the fingerprint of their record.
constexpr const char* kTag = "fingerprint";

/// A lock that goes with the process, however that ends.
class MergeLock {
 public:
  MergeLock() = default;
  ~MergeLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MergeLock(const MergeLock&) = delete;
  MergeLock& operator=(const MergeLock&) = delete;
  /// False: another process has it. Errors: nobody can have it, where nothing can be written or files know no locks.
  Expected<bool> take(const fs::path& path) {
    descriptor_ = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return true;
    if (descriptor_ >= 0 && errno == EWOULDBLOCK) return false;
    return fail(std::string("cannot be locked: ") + std::strerror(errno),
                "a folder that can be written to, on a file system with locks", path.string());
  }

 private:
  int descriptor_ = -1;
};

}  // namespace

CampaignRun::CampaignRun(const Campaign& campaign, const fs::path& file, Rank rank, const Campaign::Observer& observe)
    : campaign_(campaign),
      numbering_(campaign.head().parameters),
      file_(file),
      parts_(file.string() + ".parts"),
      tag_(fmt::format("{:016x}\n", campaign.head().fingerprint)),
      rank_(rank),
      observe_(observe),
      there_(static_cast<std::size_t>(numbering_.count())) {}

fs::path CampaignRun::part(int number) const { return parts_ / fmt::format("topology_{:06}", number); }

/// Of this campaign; another's is an error.
Expected<bool> CampaignRun::file_is_there() const {
  std::error_code code;
  if (!fs::exists(file_, code)) return false;
  const Expected<std::uint64_t> fingerprint = store::fingerprint_of(file_);
  if (fingerprint && *fingerprint == campaign_.head().fingerprint) return true;
  return fail("there is a file of that name, and not of this record", "another --out, or remove it", file_.string());
}

/// Whose the parts are, as a text; empty: nobody's.
std::string CampaignRun::parts_tag() const {
  std::ifstream stream(parts_ / kTag, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Expected<void> CampaignRun::open_parts() {
  const std::string there = parts_tag();
  if (there.empty()) return write_atomically(parts_ / kTag, tag_);
  if (there == tag_) return {};
  return fail("what was computed there is of another record: the scene, the mesh or the program has changed",
              "another --out, or remove that folder", parts_.string());
}

void CampaignRun::find_parts() {
  parallel_for(there_.size(), [&](std::size_t k) {
    const auto number = static_cast<int>(k);
    std::error_code code;
    if (!fs::exists(part(number), code)) return;
    if (read_part(part(number), campaign_.head().fingerprint, number)) {
      there_[k] = 1;
    } else {
      fs::remove(part(number), code);
    }
  });
  report_.resumed = static_cast<int>(std::count(there_.begin(), there_.end(), char{1}));
}

Expected<CampaignReport> CampaignRun::run() {
  Expected<bool> there = file_is_there();
  if (!there) return fail(std::move(there.error()));
  std::error_code code;
  if (*there) {
    if (parts_tag() == tag_) fs::remove_all(parts_, code);  // left by one that was killed after all was done
    report_.ending = Ending::was_there;
    report_.file_bytes = fs::file_size(file_, code);
    return report_;
  }
  if (Expected<void> opened = open_parts(); !opened) return fail(std::move(opened.error()));
  find_parts();

  // Every process has its share of families, those that begin with one choice of the first advance, and then helps with
  // what is missing of the others', from the other end: they meet, and at worst a task is done twice, to the same
  // bytes.
  std::vector<int> own;
  std::vector<int> others;
  for (int family = 0; family <= numbering_.per_advance(); ++family)
    (family % rank_.size == rank_.rank ? own : others).push_back(family);
  std::reverse(others.begin(), others.end());
  work_on(own, Order::forwards);
  work_on(others, Order::backwards);
  if (!trouble_) return fail(std::move(trouble_.error()));
  if (asked_to_stop_) {
    report_.ending = Ending::stopped;
    return report_;
  }
  Expected<Ending> ending = finished_ ? Expected<Ending>(Ending::left_to_another) : merge();
  if (!ending) return fail(std::move(ending.error()));
  report_.ending = *ending;
  if (report_.ending == Ending::complete) report_.file_bytes = fs::file_size(file_, code);
  return report_;
}

/// Family 0 is the body before its first advance, alone.
void CampaignRun::work_on(const std::vector<int>& families, Order order) {
  parallel_for(families.size(), [&](std::size_t k) {
    if (families[k] > 0) {
      work_on(families[k], campaign_.first_, order);
    } else if (is_missing(0)) {
      make(0, campaign_.first_);
    }
  });
}

/// What is missing of a topology and of those that follow from it.
void CampaignRun::work_on(int number, const FactoredState& before, Order order) {
  if (!is_missing_below(number)) return;
  const FactoredState state = campaign_.follow(before, number);
  if (order == Order::forwards && is_missing(number)) make(number, state);
  if (numbering_.level(number) < numbering_.advances()) {
    const int first = numbering_.child(number, {});
    for (int k = 0; k < numbering_.per_advance(); ++k)
      work_on(first + (order == Order::forwards ? k : numbering_.per_advance() - 1 - k), state, order);
  }
  if (order == Order::backwards && is_missing(number)) make(number, state);
}

void CampaignRun::make(int number, const FactoredState& state) {
  const store::TopologyData data = campaign_.recorder_->record(state);
  Expected<void> written = write_part(part(number), campaign_.head().fingerprint, number, data);
  std::error_code code;
  if (!written && fs::exists(part(number), code)) written = Expected<void>();  // another process was there first
  if (!written && fs::exists(file_, code)) finished_ = true;                   // and all of it is done
  there_[static_cast<std::size_t>(number)] = 1;
  const std::lock_guard lock(mutex_);
  if (!written && !finished_ && trouble_) trouble_ = fail(std::move(written.error()));
  if (!trouble_) stop_ = true;
  ++report_.computed;
  note_made();
}

void CampaignRun::note_made() {
  std::error_code code;
  auto count = std::count(there_.begin(), there_.end(), char{1});
  if (rank_.size > 1) {
    const fs::directory_iterator entries(parts_, code);
    if (!code)
      count = std::count_if(begin(entries), end(entries), [](const fs::directory_entry& entry) {
        const std::string name = entry.path().filename().string();
        return name.starts_with("topology_") && finished_name(name) == name;
      });
  }
  if (!observe_ || asked_to_stop_ || observe_(static_cast<int>(count), numbering_.count())) return;
  asked_to_stop_ = true;
  stop_ = true;
}

bool CampaignRun::is_missing(int number) {
  std::atomic<char>& there = there_[static_cast<std::size_t>(number)];
  if (stop_ || finished_ || there != 0) return false;
  std::error_code code;
  if (fs::exists(part(number), code)) {
    there = 1;
  } else if (fs::exists(file_, code)) {
    finished_ = true;  // the parts are taken away once the record stands
  }
  return there == 0 && !finished_;
}

bool CampaignRun::is_missing_below(int number) {
  if (is_missing(number)) return true;
  if (numbering_.level(number) == numbering_.advances()) return false;
  const int first = numbering_.child(number, {});
  for (int k = 0; k < numbering_.per_advance(); ++k) {
    if (is_missing_below(first + k)) return true;
  }
  return false;
}

Expected<Ending> CampaignRun::merge() {
  MergeLock lock;
  const Expected<bool> ours = lock.take(parts_ / "merge");
  std::error_code code;
  if (fs::exists(file_, code)) return Ending::left_to_another;
  if (!ours) return fail(ours.error());
  if (!*ours) return Ending::left_to_another;
  const fs::path whole = parts_ / "record";
  if (Expected<void> written = write_record(whole); !written) return fail(std::move(written.error()));
  fs::rename(whole, file_, code);
  if (code) return fail("cannot write: " + code.message(), "a folder that can be written to", file_.string());
  fs::remove_all(parts_, code);
  return Ending::complete;
}

Expected<void> CampaignRun::write_record(const fs::path& path) {
  Expected<store::RecordWriter> writer = store::RecordWriter::create(path, campaign_.head());
  if (!writer) return fail(std::move(writer.error()));
  for (int number = 0; number < numbering_.count(); ++number) {
    const std::optional<store::TopologyData> data = read_part(part(number), campaign_.head().fingerprint, number);
    if (!data) return fail("a part of the record has been broken", "run it again", part(number).string());
    if (Expected<void> appended = writer->append(*data); !appended) return appended;
  }
  return writer->finish();
}

}  // namespace rhexis::record::build
