// rhexis compare A B ...: the first result against each of the others.

#include <cmath>
#include <filesystem>
#include <vector>

#include "apps/command.h"
#include "result/compare.h"

namespace rhexis::apps {
namespace {

using nlohmann::ordered_json;
using result::Comparison;

ordered_json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

ordered_json to_json(const std::string& name, const Comparison& comparison) {
  ordered_json json{{"result", name}, {"fields", ordered_json::array()}};
  for (const result::FieldDifference& field : comparison.fields)
    json["fields"].push_back({{"name", field.name},
                              {"on", field.centering == mesh::Centering::point ? "nodes" : "tets"},
                              {"largest", field.largest},
                              {"largest_at", field.largest_at},
                              {"mean", field.mean},
                              {"relative_largest", field.relative_largest()},
                              {"relative_mean", field.relative_mean()}});
  json["displacement_percent_of_box"] = {{"mean", vector_json(comparison.displacement.mean)},
                                         {"largest", vector_json(comparison.displacement.largest)}};
  json["only_in_one"] = comparison.only_in_one;
  return json;
}

void print_fields(const Comparison& comparison) {
  fmt::print("{:<14} {:>6} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "field", "on", "largest", "mean", "largest/max",
             "mean/max", "at");
  for (const result::FieldDifference& field : comparison.fields)
    fmt::print("{:<14} {:>6} {:>12.4g} {:>12.4g} {:>12.3g} {:>12.3g} {:>10}\n", field.name,
               field.centering == mesh::Centering::point ? "nodes" : "tets", field.largest, field.mean,
               field.relative_largest(), field.relative_mean(), field.largest_at);
  const result::BoxDifference& box = comparison.displacement;
  fmt::print(
      "displacement, % of the bounding box   mean {:.3f} {:.3f} {:.3f}   largest {:.3f} {:.3f} {:.3f}   (x y z)\n",
      box.mean.x(), box.mean.y(), box.mean.z(), box.largest.x(), box.largest.y(), box.largest.z());
  for (const std::string& name : comparison.only_in_one) fmt::print("{} is in one of them only\n", name);
}

void print_overview(const std::vector<std::string>& names, const std::vector<Comparison>& comparisons) {
  std::size_t width = 0;
  for (const std::string& name : names) width = std::max(width, name.size());
  fmt::print("difference of the displacement from {}, percent of the body's box\n", names.front());
  fmt::print("{:<{}}  {:>7} {:>7} {:>7}   {:>7} {:>7} {:>7}\n", "", width, "mean x", "y", "z", "max x", "y", "z");
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const result::BoxDifference& box = comparisons[i].displacement;
    fmt::print("{:<{}}  {:7.3f} {:7.3f} {:7.3f}   {:7.3f} {:7.3f} {:7.3f}\n", names[i + 1], width, box.mean.x(),
               box.mean.y(), box.mean.z(), box.largest.x(), box.largest.y(), box.largest.z());
  }
}

int compare(const std::vector<std::string>& names, const Common& common) {
  std::vector<Comparison> comparisons;
  ordered_json json{{"reference", names.front()}, {"comparisons", ordered_json::array()}};
  for (std::size_t i = 1; i < names.size(); ++i) {
    Expected<Comparison> comparison = result::compare_results(names.front(), names[i]);
    if (!comparison) return report(comparison.error());
    json["comparisons"].push_back(to_json(names[i], *comparison));
    comparisons.push_back(std::move(*comparison));
  }
  if (common.json) {
    print_json(json);
  } else if (comparisons.size() == 1) {
    print_fields(comparisons.front());
  } else {
    print_overview(names, comparisons);
  }
  return kDone;
}

}  // namespace

void add_compare(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("compare", "How far two results on the same mesh are apart, field by field");
  command->footer("Example: rhexis compare out/vessel out/vessel-linear");
  auto names = std::make_shared<std::vector<std::string>>();
  command
      ->add_option(
          "results", *names,
          "result files, or folders that `rhexis solve` wrote; the first is the reference, several others give a table")
      ->required()
      ->expected(2, 1000);
  command->callback([names, &common, &code] { code = compare(*names, common); });
}

}  // namespace rhexis::apps
