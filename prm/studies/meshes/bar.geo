// The bar 4:1:1 in an unstructured mesh. Ids 1 and 2 are its ends, 3 its sides.
DefineConstant[ h = {0.275, Name "Parameters/size"} ];
Point(1) = {0, 0, 0, h};
Point(2) = {0, 1, 0, h};
Point(3) = {0, 1, 1, h};
Point(4) = {0, 0, 1, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
body[] = Extrude {4, 0, 0} { Surface{1}; };
Physical Volume(1) = body[1];
Physical Surface(1) = {1};
Physical Surface(2) = body[0];
Physical Surface(3) = {body[2], body[3], body[4], body[5]};
