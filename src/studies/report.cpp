#include "studies/report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "mesh/io/base64.h"
#include "mesh/io/xml_text.h"
#include "result/machine.h"
#include "result/summary.h"
#include "studies/report_style.h"

namespace rhexis::studies {
namespace {

using mesh::io::xml_escaped;
using nlohmann::ordered_json;

/// Longer tables are folded away, and cut: the whole is in the CSV beside.
constexpr std::size_t kLongTable = 40;
constexpr std::size_t kMostRows = 400;

/// Nothing of the page may reach out, whatever stands in it.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

std::string page(std::string_view title, std::string_view body, std::string_view script) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}{}</body>\n</html>\n",
      kPolicy, xml_escaped(title), kReportStyle, body, script);
}

bool is_number_column(const ordered_json& rows, const std::string& key) {
  return std::none_of(rows.begin(), rows.end(), [&](const ordered_json& row) { return row.at(key).is_string(); });
}

std::string table_html(const StudyTable& table) {
  const ordered_json& rows = table.rows;
  std::string out = "<table>\n";
  out += fmt::format("<caption><b>{}</b>{}{}</caption>\n<thead><tr>", xml_escaped(table.name),
                     table.caption.empty() ? "" : ": ", xml_escaped(table.caption));
  std::vector<std::pair<std::string, bool>> columns;
  for (const auto& [key, value] : rows.front().items()) columns.emplace_back(key, is_number_column(rows, key));
  const auto cell = [](bool number, const std::string& text, std::string_view element) {
    return fmt::format("<{0}{1}>{2}</{0}>", element, number ? " class=\"n\"" : "", xml_escaped(text));
  };
  for (const auto& [key, number] : columns) out += cell(number, key, "th");
  out += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < std::min(rows.size(), kMostRows); ++r) {
    out += "<tr>";
    for (const auto& [key, number] : columns) out += cell(number, cell_text(rows[r].at(key)), "td");
    out += "</tr>\n";
  }
  out += "</tbody></table>\n";
  if (rows.size() > kMostRows)
    out += fmt::format("<p class=\"quiet\">{} rows more are in {}.csv.</p>\n", rows.size() - kMostRows,
                       xml_escaped(table.name));
  out = "<div class=\"scroll\">\n" + out + "</div>\n";
  if (rows.size() <= kLongTable) return out;
  return fmt::format("<details><summary>{}: {} rows</summary>\n{}</details>\n", xml_escaped(table.name), rows.size(),
                     out);
}

std::string published_html(const ordered_json& rows) {
  if (rows.empty()) return {};
  std::string out =
      "<h2>Beside the published numbers</h2>\n<div class=\"scroll\"><table "
      "class=\"published\">\n<thead><tr><th>what</th>"
      "<th class=\"n\">published</th><th class=\"n\">ours</th><th>unit</th><th class=\"n\">ours / published</th>"
      "<th>source</th><th>where and why they differ</th></tr></thead>\n<tbody>\n";
  for (const ordered_json& row : rows) {
    const auto value = [&](const char* key) {
      const bool words = row.at(key).is_string();
      return fmt::format("<td class=\"{}\">{}</td>", words ? "words" : "n", xml_escaped(cell_text(row.at(key))));
    };
    out += fmt::format("<tr><td class=\"words\">{}</td>{}{}<td>{}</td>{}<td>{}</td><td class=\"why\">{}</td></tr>\n",
                       xml_escaped(row.at("what").get<std::string>()), value("published"), value("ours"),
                       xml_escaped(row.at("unit").get<std::string>()), value("ratio"),
                       xml_escaped(row.at("source").get<std::string>()), xml_escaped(row.at("why").get<std::string>()));
  }
  return out + "</tbody></table></div>\n";
}

template <class T, class Values>
std::string base64_of(const Values& values) {
  std::vector<T> packed;
  for (const auto& value : values) packed.push_back(static_cast<T>(value));
  return mesh::io::base64_encode({reinterpret_cast<const char*>(packed.data()), packed.size() * sizeof(T)});
}

std::vector<double> flat(const std::vector<Vec3>& vectors) {
  std::vector<double> out;
  for (const Vec3& v : vectors) out.insert(out.end(), v.data(), v.data() + 3);
  return out;
}

/// What viewer/src/report reads: lists of little-endian 32-bit numbers in base64.
std::string shapes_json(const result::ShapePicture& picture) {
  std::vector<std::int32_t> corners;
  for (const auto& face : picture.surface.faces) corners.insert(corners.end(), face.begin(), face.end());
  ordered_json json{{"reference", base64_of<float>(flat(picture.surface.nodes))},
                    {"faces", base64_of<std::uint32_t>(corners)},
                    {"field", picture.field},
                    {"unit", picture.unit},
                    {"signed", picture.has_sign},
                    {"top", result::top_of(picture)},
                    {"panels", ordered_json::array()}};
  for (const result::ShapePanel& panel : picture.panels)
    json["panels"].push_back({{"title", panel.title},
                              {"displacement", base64_of<float>(flat(panel.displacement))},
                              {"values", base64_of<float>(panel.values)}});
  std::string text = json.dump();
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
    text.replace(at, 1, "\\u003c");
  return text;
}

struct ItemHtml {
  std::string operator()(const StudyTable& table) const { return table_html(table); }
  std::string operator()(const StudyFigure& figure) const {
    return fmt::format("<figure>\n{}<figcaption>{}</figcaption></figure>\n", figure.svg, xml_escaped(figure.caption));
  }
  std::string operator()(const StudyShapes& shapes) const {
    std::string out = fmt::format("<figure class=\"shapes\">\n<div class=\"still\">{}</div>\n", shapes.svg);
    if (turns)
      out += fmt::format("<div class=\"turned\"><b>{}</b></div>\n<script type=\"application/json\">{}</script>\n",
                         xml_escaped(shapes.picture.title), shapes_json(shapes.picture));
    return out + fmt::format("<figcaption>{}</figcaption></figure>\n", xml_escaped(shapes.caption));
  }
  bool turns;
};

std::string facts_html(const ordered_json& about) {
  std::string out = "<h2>How it was made</h2>\n<dl>\n";
  const auto fact = [&](std::string_view name, const std::string& value) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", xml_escaped(name), xml_escaped(value));
  };
  fact("command", about.at("command"));
  fact("time",
       fmt::format("{:.1f} s on {} threads", about.at("seconds").get<double>(), about.at("threads").get<int>()));
  for (const char* group : {"machine", "versions"})
    for (const auto& [key, value] : about.at(group).items())
      fact(key, value.is_string() ? value.get<std::string>() : value.dump());
  return out + "</dl>\n";
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

ordered_json about_run(const StudyFolder& folder, const StudyRun& run) {
  ordered_json about{{"study", run.study},
                     {"title", run.title},
                     {"command", run.command},
                     {"seconds", run.seconds},
                     {"threads", run.threads},
                     {"stopped", run.stopped},
                     {"published", folder.contents().published}};
  about["tables"] = ordered_json::array();
  about["figures"] = ordered_json::array();
  for (const StudyItem& item : folder.contents().items)
    std::visit(
        [&](const auto& one) {
          about[std::is_same_v<std::decay_t<decltype(one)>, StudyTable> ? "tables" : "figures"].push_back(one.name);
        },
        item);
  about["versions"] = result::versions();
  about["machine"] = result::machine();
  return ordered_json::parse(about.dump());  // what is not finite is null from here on
}

constexpr std::string_view kNotTurning =
    "<p class=\"quiet\">The shapes of this report stand still: the page of this program was not built. "
    "<code>make viewer</code> builds it; run the study again then.</p>\n";
constexpr std::string_view kTurning =
    "<p class=\"quiet turn-hint\">Drag a shape to turn it; click it, then the wheel brings it nearer; a double click "
    "shows the whole of it. All shapes of a figure turn together.</p>\n";

}  // namespace

std::string cell_text(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return value.dump();
  if (!value.is_number_float() || !std::isfinite(value.get<double>())) return "–";
  return fmt::format("{:.4g}", value.get<double>());
}

Expected<void> write_report(const StudyFolder& folder, const StudyRun& run, const std::filesystem::path& viewer) {
  const ordered_json about = about_run(folder, run);
  if (Expected<void> done = write_atomically(folder.path() / "study.json", about.dump(2) + "\n"); !done) return done;

  const StudyContents& contents = folder.contents();
  const bool has_shapes = std::any_of(contents.items.begin(), contents.items.end(),
                                      [](const StudyItem& item) { return std::holds_alternative<StudyShapes>(item); });
  std::string script = has_shapes ? slurp(viewer) : std::string();
  const bool turns = !script.empty();
  std::string body = fmt::format("<h1>{}</h1>\n<p class=\"quiet\">rhexis study {}</p>\n", xml_escaped(run.title),
                                 xml_escaped(run.study));
  if (run.stopped) body += "<p class=\"warning\">Stopped before its end: this is what was measured until then.</p>\n";
  for (const std::string& note : contents.notes) body += fmt::format("<p>{}</p>\n", xml_escaped(note));
  body += published_html(about.at("published"));
  body += "<h2>Tables and figures</h2>\n";
  if (has_shapes) body += turns ? kTurning : kNotTurning;
  for (const StudyItem& item : contents.items) body += std::visit(ItemHtml{turns}, item);
  body += facts_html(about);
  if (turns) {
    // No text of the script may end it.
    for (std::size_t at = script.find("</script"); at != std::string::npos; at = script.find("</script", at))
      script.replace(at, 8, "<\\/script");
    script = "<script>" + script + "</script>\n";
  }
  return write_atomically(folder.path() / "report.html", page(run.title, body, script));
}

Expected<void> write_report_index(const std::filesystem::path& folder, const std::vector<StudyRun>& runs) {
  std::string body =
      "<h1>The studies</h1>\n<p>One report a study: tables, figures, and the published numbers beside ours.</p>\n"
      "<div class=\"scroll\"><table>\n<thead><tr><th>study</th><th>what it asks</th><th class=\"n\">time / s</th>"
      "<th>command</th></tr></thead>\n<tbody>\n";
  for (const StudyRun& run : runs)
    body += fmt::format(
        "<tr><td><a href=\"{0}/report.html\">{0}</a></td><td>{1}{2}</td><td "
        "class=\"n\">{3:.1f}</td><td><code>{4}</code>"
        "</td></tr>\n",
        xml_escaped(run.study), xml_escaped(run.title), run.stopped ? " (stopped before its end)" : "", run.seconds,
        xml_escaped(run.command));
  body += "</tbody></table></div>\n";
  return write_atomically(folder / "index.html", page("The studies", body, ""));
}

}  // namespace rhexis::studies
