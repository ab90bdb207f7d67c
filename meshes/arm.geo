// A straight arm of boxes [m]: two bones, a muscle above and one below the elbow at x = 0.3, flesh around. Its elements are of some 12 mm.
SetFactory("OpenCASCADE");
Box(1) = {0, -0.036, -0.044, 0.56, 0.072, 0.088};     // flesh and skin
Box(2) = {0, -0.009, -0.009, 0.285, 0.018, 0.018};    // upper bone
Box(3) = {0.315, -0.009, -0.009, 0.245, 0.018, 0.018}; // lower bone
Box(4) = {0.06, -0.018, 0.009, 0.315, 0.036, 0.024};  // biceps
Box(5) = {0.06, -0.018, -0.033, 0.315, 0.036, 0.024}; // triceps
parts() = BooleanFragments{ Volume{1}; Delete; }{ Volume{2:5}; Delete; };
Physical Volume("upper", 2) = {2};
Physical Volume("lower", 3) = {3};
Physical Volume("biceps", 4) = {4};
Physical Volume("triceps", 5) = {5};
Physical Volume("flesh", 1) = {6};
Mesh.MeshSizeMin = 0.012;
Mesh.MeshSizeMax = 0.018;
