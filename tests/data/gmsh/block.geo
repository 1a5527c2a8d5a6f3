// A block of 2 x 1 x 3 m with everything a file may have: groups of all dimensions, one without a
// name, one inside, and points that belong to no cell. Made with Gmsh 4.8, quadratic elements:
//   gmsh -3 -format msh41 -order 2 block.geo -o block_tet10.msh          (-bin for the binary)
//   gmsh -3 -format msh41 -order 2 -setnumber hex 1 -setnumber Mesh.SecondOrderIncomplete 1 ...
// and with -order 1 as tet4, hex8. Older formats: -format msh22, and msh40, to be refused.
DefineConstant[ hex = 0 ];
Mesh.MeshSizeMin = 10;
Mesh.MeshSizeMax = 10;
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {2, 1, 0};
Point(4) = {0, 1, 0};
Point(9) = {5, 5, 5};  // of no cell
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
If (hex == 1)
  Transfinite Curve{1, 2, 3, 4} = 2;
  Transfinite Surface{1};
  Recombine Surface{1};
  lower[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; };
  upper[] = Extrude {0, 0, 2} { Surface{lower[0]}; Layers{1}; Recombine; };
Else
  lower[] = Extrude {0, 0, 1} { Surface{1}; };
  upper[] = Extrude {0, 0, 2} { Surface{lower[0]}; };
EndIf
Physical Volume("steel") = {lower[1]};
Physical Volume("lead") = {upper[1]};
Physical Surface("bottom") = {1};
Physical Surface("top of it") = {upper[0]};
Physical Surface("between") = {lower[0]};
Physical Surface(77) = {lower[2], upper[2]};
Physical Curve("edge") = {1};
Physical Point("origin") = {1};
