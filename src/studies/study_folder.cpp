#include "studies/study_folder.h"

#include <string>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/check.h"
#include "studies/published.h"

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

Expected<void> StudyFolder::write_table(std::string_view name, const ordered_json& rows,
                                        std::string_view caption) const {
  RHEXIS_CHECK(rows.is_array() && !rows.empty(), "table '{}' without rows", name);
  const std::string stem(name);
  // A dump says null for what is not finite; read back, the same stands in both files.
  ordered_json clean = ordered_json::parse(rows.dump());
  if (Expected<void> done = write_atomically(path_ / (stem + ".csv"), csv(clean)); !done) return done;
  if (Expected<void> done = write_atomically(path_ / (stem + ".json"), clean.dump(2) + "\n"); !done) return done;
  keep(StudyTable{stem, std::string(caption), std::move(clean)});
  return {};
}

Expected<void> StudyFolder::write_figure(std::string_view name, const result::Chart& chart,
                                         std::string_view caption) const {
  const std::filesystem::path file = path_ / (std::string(name) + ".svg");
  Expected<std::string> svg = result::chart_svg(chart);
  if (!svg) return fail(svg.error().at(file.string()));
  if (Expected<void> done = write_atomically(file, *svg); !done) return done;
  keep(StudyFigure{std::string(name), std::string(caption), std::move(*svg)});
  return {};
}

Expected<void> StudyFolder::write_shapes(std::string_view name, const result::ShapePicture& picture,
                                         std::string_view caption) const {
  std::string svg = result::shape_svg(picture);
  if (Expected<void> done = write_atomically(path_ / (std::string(name) + ".svg"), svg); !done) return done;
  keep(StudyShapes{std::string(name), std::string(caption), std::move(svg), picture});
  return {};
}

void StudyFolder::note(std::string text) const { contents_->notes.push_back(std::move(text)); }

void StudyFolder::compare(std::string_view id, const ordered_json& ours, const std::string& why) const {
  ordered_json row = beside_published(id, ours, why);
  for (ordered_json& before : contents_->published) {
    if (before.at("id") != id) continue;
    before = std::move(row);
    return;
  }
  contents_->published.push_back(std::move(row));
}

void StudyFolder::keep(StudyItem item) const {
  const auto name_of = [](const StudyItem& one) {
    return std::visit([](const auto& inner) { return inner.name; }, one);
  };
  for (StudyItem& before : contents_->items) {
    if (before.index() != item.index() || name_of(before) != name_of(item)) continue;
    before = std::move(item);
    return;
  }
  contents_->items.push_back(std::move(item));
}

}  // namespace rhexis::studies
