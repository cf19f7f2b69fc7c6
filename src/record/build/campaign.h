#pragma once

/// The campaign that makes a record: every topology is a task whose result is a file of its own, so that any number of
/// threads and processes may work at it, and one that is killed loses the tasks in flight alone. When all are there one
/// process puts them together. The bytes of the record depend on none of this.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "record/build/ranks.h"
#include "record/build/recorder.h"
#include "record/build/torn_state.h"
#include "record/store/record.h"

namespace rhexis::record::build {

struct CampaignRequest {
  mesh::TetMesh mesh;
  response::ElasticBody elastic;
  fracture::CrackLine crack;
  store::Parameters parameters;
  bool single_precision = false;
  std::string program;  ///< "rhexis 0.1.0"
  std::string title;
};

/// What tells one record from another: a hash of the mesh, the material, the supports, the loads, the crack, the
/// parameters, the precision, the program and the method.
[[nodiscard]] std::uint64_t fingerprint_of(const CampaignRequest& request);

enum class Ending {
  complete,         ///< this process put the record together
  was_there,        ///< the file is there already, of the same fingerprint
  left_to_another,  ///< nothing is left to do here; another process puts it together, or has done so
  stopped,          ///< the observer asked for it
};

struct CampaignReport {
  Ending ending = Ending::complete;
  int resumed = 0;               ///< topologies that were there at the start
  int computed = 0;              ///< by this process
  std::uint64_t file_bytes = 0;  ///< of the record, when it is there
};

class Campaign {
 public:
  /// Told how many topologies are there, one call at a time. False: stop.
  using Observer = std::function<bool(int there, int all)>;

  /// Cuts the first crack and solves the body once. Errors: of the crack; a body that it leaves unstable.
  static Expected<Campaign> plan(CampaignRequest request);

  [[nodiscard]] const store::RecordHead& head() const { return head_; }
  [[nodiscard]] int topologies() const { return store::Numbering(head_.parameters).count(); }
  /// The most advances whose record takes at most `bytes`. Errors: not even one does.
  Expected<void> choose_advances(double bytes);

  /// Works in `file` + ".parts" until nothing is missing, then makes `file` of it. Errors: another record's file or
  /// parts are in the way, or the disk.
  Expected<CampaignReport> run(const std::filesystem::path& file, Rank rank, const Observer& observe) const;

 private:
  friend class CampaignRun;
  Campaign(CampaignRequest request, std::unique_ptr<const Recorder> recorder, FactoredState first);
  /// What follows from a topology by the last choice of `number`.
  [[nodiscard]] FactoredState follow(const FactoredState& before, int number) const;
  void take_parameters();

  CampaignRequest request_;
  std::unique_ptr<const Recorder> recorder_;
  FactoredState first_;
  store::RecordHead head_;
};

}  // namespace rhexis::record::build
