// Cook's membrane, 64 x 64 cells in its plane and one across: ids 1 and 2 are the held and the
// loaded edge, 3 both sides.
n = 64;
Point(1) = {0, 0, 0};
Point(2) = {48, 44, 0};
Point(3) = {48, 60, 0};
Point(4) = {0, 44, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1:4} = n + 1;
Transfinite Surface{1} Alternated;
body[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; };
Physical Volume(1) = body[1];
Physical Surface(1) = body[5];
Physical Surface(2) = body[3];
Physical Surface(3) = {1, body[0]};
