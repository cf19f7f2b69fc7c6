#pragma once

/// One process at work in the folder of a campaign.

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "record/build/campaign.h"

namespace rhexis::record::build {

class CampaignRun {
 public:
  CampaignRun(const Campaign& campaign, const std::filesystem::path& file, Rank rank,
              const Campaign::Observer& observe);
  Expected<CampaignReport> run();

 private:
  enum class Order { forwards, backwards };
  [[nodiscard]] std::filesystem::path part(int number) const;
  Expected<bool> file_is_there() const;
  [[nodiscard]] std::string parts_tag() const;
  Expected<void> open_parts();
  void find_parts();
  void work_on(const std::vector<int>& families, Order order);
  void work_on(int number, const FactoredState& before, Order order);
  void make(int number, const FactoredState& state);
  bool is_missing(int number);
  bool is_missing_below(int number);
  void note_made();
  Expected<Ending> merge();
  Expected<void> write_record(const std::filesystem::path& path);

  const Campaign& campaign_;
  store::Numbering numbering_;
  std::filesystem::path file_;
  std::filesystem::path parts_;
  std::string tag_;
  Rank rank_;
  const Campaign::Observer& observe_;
  std::vector<std::atomic<char>> there_;  ///< per topology: its part has been seen
  std::atomic<bool> stop_ = false;        ///< asked for, or after an error
  std::atomic<bool> finished_ = false;    ///< another process has made the record
  std::mutex mutex_;                      ///< of what follows
  Expected<void> trouble_;
  bool asked_to_stop_ = false;
  CampaignReport report_;
};

}  // namespace rhexis::record::build
