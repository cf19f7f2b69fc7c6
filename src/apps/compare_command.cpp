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

struct Options {
  std::string reference;
  std::vector<std::string> others;
};

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

void print_overview(const Options& options, const std::vector<Comparison>& comparisons) {
  std::size_t width = 0;
  for (const std::string& name : options.others) width = std::max(width, name.size());
  fmt::print("difference of the displacement from {}, percent of the body's box\n", options.reference);
  fmt::print("{:<{}}  {:>7} {:>7} {:>7}   {:>7} {:>7} {:>7}\n", "", width, "mean x", "y", "z", "max x", "y", "z");
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const result::BoxDifference& box = comparisons[i].displacement;
    fmt::print("{:<{}}  {:7.3f} {:7.3f} {:7.3f}   {:7.3f} {:7.3f} {:7.3f}\n", options.others[i], width, box.mean.x(),
               box.mean.y(), box.mean.z(), box.largest.x(), box.largest.y(), box.largest.z());
  }
}

int compare(const Options& options, const Common& common) {
  std::vector<Comparison> comparisons;
  ordered_json json{{"reference", options.reference}, {"comparisons", ordered_json::array()}};
  for (const std::string& other : options.others) {
    Expected<Comparison> comparison = result::compare_results(options.reference, other);
    if (!comparison) return report(comparison.error());
    json["comparisons"].push_back(to_json(other, *comparison));
    comparisons.push_back(std::move(*comparison));
  }
  if (common.json) {
    print_json(json);
  } else if (common.quiet) {
    return kDone;
  } else if (comparisons.size() == 1) {
    print_fields(comparisons.front());
  } else {
    print_overview(options, comparisons);
  }
  return kDone;
}

}  // namespace

void add_compare(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("compare", "How far two results on the same mesh are apart, field by field");
  command->footer("Example: rhexis compare out/vessel out/vessel-linear");
  auto options = std::make_shared<Options>();
  command->add_option("reference", options->reference, "result file, or folder that `rhexis solve` wrote")->required();
  command->add_option("other", options->others, "what to compare with it; several give a table")
      ->required()
      ->expected(-1);
  command->callback([options, &common, &code] { code = compare(*options, common); });
}

}  // namespace rhexis::apps
