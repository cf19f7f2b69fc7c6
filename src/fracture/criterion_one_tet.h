#pragma once

/// The three criteria that judge by one tet, as the thesis does: the one of the largest value decides whether and in
/// which direction. They differ in the value and in the planes that it offers.

#include <memory>
#include <string_view>

#include "fracture/criterion.h"

namespace rhexis::fracture {

/// "maximum-principal", "maximum-shear" or "von-mises"; nullptr for any other name.
[[nodiscard]] std::unique_ptr<Criterion> make_one_tet_criterion(std::string_view name,
                                                                const CriterionSettings& settings);

}  // namespace rhexis::fracture
