#pragma once

/// Named values on nodes or tets: what results carry and files hold.

#include <string>
#include <string_view>
#include <vector>

namespace rhexis::mesh {

enum class Centering { point, cell };

struct Field {
  std::string name;
  Centering centering = Centering::point;
  int components = 1;          ///< 1 scalar, 3 vector, 6 symmetric tensor in the order xx yy zz xy yz xz
  std::vector<double> values;  ///< entity-major: value c of entity i at i * components + c
};

}  // namespace rhexis::mesh
