#include "scene/reference.h"

namespace rhexis::scene {

std::string scene_reference_example() {
  return R"(title = "Vessel, pulled aside"
gravity = [0.0, 0.0, -9.81]               # m/s2

[mesh]
file = "vessel.msh"                       # relative to this file
unit = "mm"                               # of the mesh file; all else is SI
# or: generate = "tube", radius = 0.005, length = 0.04, nodes = 401

[sets.top]
side = "+z"                               # a side of the bounding box: nodes and faces
[sets.belt]
box = { from = [0.0, 0.0, 0.45], to = [0.5, 1.0, 0.55] }
[sets.tip]
nearest = [0.0, 0.0, 0.04]                # one node
[sets.picked]
nodes = [3, 17, 42]                       # 0-based, in the order of the file

[material]
density = 510.0                           # kg/m3
young = 1.0e6                             # Pa
poisson = 0.49

[model]
kind = "hyperelastic"
beta = "auto"
initial_lambda = 300.0                    # Pa

[[support]]
set = "top"
x = 0.0                                   # m; a component that is left out is free
y = 0.0
z = 0.0
[[support]]
set = "belt"
x = "50%"                                 # of the body's box in x

[[traction]]
side = "-z"
force = [0.0, 0.5, 0.0]                   # N in all, in a fixed direction
[[pressure]]
set = "inner"                             # a surface of the mesh file
value = 1.0e4                             # Pa, against the outward normal

[solver]
steps = 10
tolerance = 1e-8

[dynamics]                                # from here on: for holding and tearing
stiffness_damping = 0.005                 # s
[fracture]
criterion = "maximum-principal"
strength = 0.4e6                          # Pa
[[crack]]
from = [-0.005, 0.0, 0.02]
to = [-0.003, 0.0, 0.02]
through = [0.0, 1.0, 0.0]
[record]                                  # of `rhexis precompute`
advances = 2
lengths = [0.002]                         # m
[interaction]
response = "exact"
[[pull]]
at = [0.0, 0.005, 0.02]                   # the nearest point of the surface is held,
by = [0.0, 0.02, 0.0]                     # moved so far
seconds = 2.0                             # in this time,
hold = 0.5                                # let go after this,
wait = 1.0                                # and left alone for this
)";
}

}  // namespace rhexis::scene
