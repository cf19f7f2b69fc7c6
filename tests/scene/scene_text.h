#pragma once

/// A good scene, and ways to spoil it line by line.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/scene.h"

namespace rhexis::scene::test {

inline const std::string kGood = R"(title = "Bar"
gravity = [0.0, 0.0, -9.81]

[mesh]
generate = "bar"
size = [0.04, 0.01, 0.01]
nodes = 200

[sets.wall]
side = "-x"
[sets.tip]
nearest = [0.04, 0.0, 0.0]

[material]
density = 1000.0
young = 1.0e6
poisson = 0.45

[model]
kind = "hyperelastic"
beta = 100.0

[[support]]
set = "wall"
x = 0.0
y = 0.0
z = 0.0
[[support]]
set = "tip"
z = "-10%"

[solver]
steps = 4
)";

/// kGood with one piece replaced; an empty `old` appends.
inline std::string spoil(const std::string& old, const std::string& with, std::string text = kGood) {
  if (old.empty()) return text + with;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << "the good scene has no: " << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), with);
}

/// What parse_scene says of a text: the line that is printed, or "good".
inline std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Expected<Scene> scene = parse_scene(text, "s.toml", overrides);
  return scene ? "good" : scene.error().message();
}

}  // namespace rhexis::scene::test
