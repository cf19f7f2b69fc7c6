// The body of the fixtures: a box with groups of every dimension, shared and unnamed ones. See make_fixtures.py.
SetFactory("Built-in");
h = 2;
Point(1) = {0, 0, 0, h};
line[] = Extrude {1, 0, 0} { Point{1}; };
side[] = Extrude {0, 0.5, 0} { Line{line[1]}; };
body[] = Extrude {0, 0, 0.25} { Surface{side[1]}; };
Physical Volume("body") = {body[1]};
Physical Volume("all of it") = {body[1]};
Physical Surface("top") = {body[0]};
Physical Surface("cap") = {body[0]};
Physical Surface(11) = {side[1]};
Physical Curve("edge") = {line[1]};
Physical Point("corner") = {1};
