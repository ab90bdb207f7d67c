// An eye in its socket [m], in two pieces: a ball about the origin with a cornea that looks to x, and a block of flesh around, .4 mm wider than the ball, with
// an opening between two lids. Elements are of some 3 mm.
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.012};
Sphere(2) = {0.0055, 0, 0, 0.0075};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {-0.018, -0.02, -0.018, 0.03, 0.04, 0.036};
Sphere(5) = {0, 0, 0, 0.0124};
Box(6) = {0.002, -0.01, -0.0055, 0.02, 0.02, 0.011};
BooleanDifference(7) = { Volume{4}; Delete; }{ Volume{5, 6}; Delete; };
Physical Volume("eye", 1) = {3};
Physical Volume("socket", 2) = {7};
Mesh.MeshSizeMin = 0.0028;
Mesh.MeshSizeMax = 0.0032;
