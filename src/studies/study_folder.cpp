#include "studies/study_folder.h"

#include <string>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/check.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

/// RFC 4180: quoted where a separator, a quote or an end of line stands inside.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"') out += c;
  }
  return out + "\"";
}

std::string csv_cell(const ordered_json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? csv_text(value.get<std::string>()) : value.dump();
}

std::string csv(const ordered_json& rows) {
  std::string out;
  const auto add_line = [&](auto&& cell) {
    bool first = true;
    for (const auto& [key, value] : rows.front().items()) {
      if (!first) out += ',';
      out += cell(key);
      first = false;
    }
    out += '\n';
  };
  add_line([](const std::string& key) { return csv_text(key); });
  for (const ordered_json& row : rows) {
    RHEXIS_CHECK(row.size() == rows.front().size(), "{} keys in one row, {} in the first", row.size(),
                 rows.front().size());
    add_line([&](const std::string& key) { return csv_cell(row.at(key)); });
  }
  return out;
}

}  // namespace

Expected<StudyFolder> StudyFolder::open(std::filesystem::path path) {
  std::error_code code;
  std::filesystem::create_directories(path, code);
  if (code) return fail("cannot make the folder: " + code.message(), "choose another with --out", path.string());
  return StudyFolder(std::move(path));
}

Expected<void> StudyFolder::write_table(std::string_view name, const ordered_json& rows) const {
  RHEXIS_CHECK(rows.is_array() && !rows.empty(), "table '{}' without rows", name);
  const std::string stem(name);
  // A dump says null for what is not finite; read back, the same stands in both files.
  const ordered_json clean = ordered_json::parse(rows.dump());
  if (Expected<void> done = write_atomically(path_ / (stem + ".csv"), csv(clean)); !done) return done;
  return write_atomically(path_ / (stem + ".json"), clean.dump(2) + "\n");
}

Expected<void> StudyFolder::write_figure(std::string_view name, const result::Chart& chart) const {
  return result::write_chart(path_ / (std::string(name) + ".svg"), chart);
}

}  // namespace rhexis::studies
