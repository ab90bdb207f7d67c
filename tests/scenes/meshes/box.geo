SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 0.3, 0.3};
Mesh.MeshSizeFactor = 4;
Physical Volume("body", 1) = {1};
Physical Surface("left", 2) = {1};
