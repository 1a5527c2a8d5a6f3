// A plate of 3 x 2 m with a round hole of radius 0.5 m, quadratic elements with curved sides:
//   gmsh -2 -format msh41 -order 2 plate.geo -o plate_tri6.msh
//   gmsh -2 -format msh41 -order 2 -setnumber quads 1 -setnumber Mesh.SecondOrderIncomplete 1
//     plate.geo -o plate_quad8.msh
DefineConstant[ quads = 0 ];
Mesh.MeshSizeMin = 0.6;
Mesh.MeshSizeMax = 0.6;
Point(1) = {0, 0, 0};
Point(2) = {3, 0, 0};
Point(3) = {3, 2, 0};
Point(4) = {0, 2, 0};
Point(5) = {1, 1, 0};  // centre of the hole: of no cell
Point(6) = {1.5, 1, 0};
Point(7) = {0.5, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Circle(5) = {6, 5, 7};
Circle(6) = {7, 5, 6};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6};
Plane Surface(1) = {1, 2};
If (quads == 1)
  Recombine Surface{1};
EndIf
Physical Surface("plate") = {1};
Physical Curve("left") = {4};
Physical Curve("right") = {2};
Physical Curve("hole") = {5, 6};
Physical Point("corner") = {1};
