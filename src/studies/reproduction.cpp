#include "studies/reproduction.h"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "studies/published.h"
#include "studies/report.h"

namespace rhexis::studies {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::string_view kHead =
    "# What was published, and what we measure\n\n"
    "Every number of the two papers that a study measures again: theirs, ours, the ratio, and why they differ. *The "
    "paper* is Ogata, Nagasaka and Yamada on deformation models, *the thesis* is on tearing with "
    "force feedback.\n"
    "This page is made from the `study.json` that each study writes ([studies](studies.md)), kept in "
    "`docs/reproduction`; a test holds it to them. Make it anew:\n\n"
    "```sh\n"
    "rhexis study all --out out/studies\n"
    "for study in out/studies/*/study.json; do cp $study docs/reproduction/$(basename $(dirname $study)).json; done\n"
    "rhexis study reproduction docs/reproduction > docs/reproduction.md\n"
    "```\n\n"
    "Neither the meshes nor the machines of the papers are at hand: ratios and trends are what can be compared, and a "
    "ratio far from 1 has its reason beside it.\n";

/// Of a study; null where it is not there.
Expected<ordered_json> read_study(const fs::path& folder, const std::string& name) {
  fs::path path = folder / (name + ".json");
  if (!fs::exists(path)) path = folder / name / "study.json";
  if (!fs::exists(path)) return ordered_json();
  std::ifstream file(path);
  ordered_json study = ordered_json::parse(file, nullptr, false);
  const bool is_one = study.is_object() && study.contains("published") && study["published"].is_array() &&
                      study.contains("command") && study["command"].is_string() && study.contains("machine") &&
                      study["machine"].is_object() && study.contains("seconds") && study["seconds"].is_number() &&
                      study.contains("threads") && study["threads"].is_number();
  if (!is_one) return fail("it is no study.json", "what `rhexis study " + name + "` wrote", path.string());
  return study;
}

const ordered_json* find_row(const ordered_json& study, std::string_view id) {
  if (study.is_null()) return nullptr;
  for (const ordered_json& row : study.at("published"))
    if (row.is_object() && row.contains("id") && row["id"] == id && row.contains("ours") && row.contains("ratio") &&
        row.contains("why") && row["why"].is_string())
      return &row;
  return nullptr;
}

/// A `|` would end the cell.
std::string markdown_cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.replace(at, 1, "\\|");
  return text;
}

std::string line_of(const Published& one, const ordered_json* row) {
  const std::string theirs = one.value ? cell_text(*one.value) : std::string(one.trend);
  const bool measured = row != nullptr && !row->at("ours").is_null();
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", markdown_cell(std::string(one.what)),
                     markdown_cell(theirs), measured ? markdown_cell(cell_text(row->at("ours"))) : "not measured",
                     one.unit, measured && !row->at("ratio").is_null() ? cell_text(row->at("ratio")) : "", one.source,
                     row != nullptr ? markdown_cell(row->at("why").get<std::string>()) : "");
}

}  // namespace

Expected<std::string> reproduction_markdown(const fs::path& folder) {
  std::string out(kHead);
  std::string name;
  ordered_json study;
  for (const Published& one : published_numbers()) {
    if (one.study() != name) {
      name = one.study();
      Expected<ordered_json> read = read_study(folder, name);
      if (!read) return fail(std::move(read.error()));
      study = std::move(*read);
      out += fmt::format("\n## {}\n\n", name);
      out += study.is_null()
                 ? "Not measured yet.\n\n"
                 : fmt::format("`{}`, {:.0f} s on {} threads of {}.\n\n", study["command"].get<std::string>(),
                               study["seconds"].get<double>(), study["threads"].get<int>(),
                               study["machine"].value("processor", "an unnamed processor"));
      out +=
          "| what | published | ours | unit | ours / published | source | why they differ |\n"
          "| --- | ---: | ---: | --- | ---: | --- | --- |\n";
    }
    out += line_of(one, find_row(study, one.id));
  }
  return out;
}

}  // namespace rhexis::studies
