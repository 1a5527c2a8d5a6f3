// A bumper: half a ring of hexahedra in millimetres, its crown towards +x.
//   gmsh -3 bumper.geo -o bumper.msh
Mesh.MshFileVersion = 4.1;
inner = 24; outer = 30; width = 20;
Point(1) = {0, 0, 0};
Point(2) = {0, -inner, 0};  Point(3) = {inner, 0, 0};  Point(4) = {0, inner, 0};
Point(5) = {0, -outer, 0};  Point(6) = {outer, 0, 0};  Point(7) = {0, outer, 0};
Circle(1) = {2, 1, 3};  Circle(2) = {3, 1, 4};
Circle(3) = {5, 1, 6};  Circle(4) = {6, 1, 7};
Line(5) = {2, 5};  Line(6) = {3, 6};  Line(7) = {4, 7};
Curve Loop(1) = {1, 6, -3, -5};  Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -4, -6};  Plane Surface(2) = {2};
Transfinite Curve {1, 2, 3, 4} = 13;  // nodes along a quarter
Transfinite Curve {5, 6, 7} = 4;      // and through the thickness
Transfinite Surface {1, 2};  Recombine Surface {1, 2};
lower[] = Extrude {0, 0, width} { Surface{1}; Layers{4}; Recombine; };
upper[] = Extrude {0, 0, width} { Surface{2}; Layers{4}; Recombine; };
Physical Volume("bumper") = {lower[1], upper[1]};
Physical Surface("feet") = {lower[5], upper[3]};
Physical Surface("crown") = {lower[4], upper[4]};
