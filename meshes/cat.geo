// A standing cat, one solid.  Units: m.  Facing +x, up +z, left +y (its right
// side is y < 0); the soles are flat at z = 0; shape symmetric in y about 0 (the
// mesh is not).  Chest to rump about 1.03 m.
// Extents: x -0.78 .. 0.75, y -0.15 .. 0.15, z 0 .. 1.07.
//   fore paws   centre ( 0.385, -+0.085, 0.03)   paw  x  0.29 ..  0.46
//   hind paws   centre (-0.384, -+0.090, 0.03)   paw  x -0.49 .. -0.31
//   head        centre ( 0.59, 0, 0.75), radius about 0.14; nose (0.75, 0, 0.70);
//               ear tips (0.572, -+0.098, 0.960)
//   tail        root (-0.50, 0, 0.52), rises at x = -0.74, tip (-0.59, 0, 1.05)
// Made with gmsh 4.8.4 by
//   gmsh -3 cat.geo -o cat.msh
// giving 10183 tetrahedra and 2868 nodes; to fit hs and hi again:
//   fit_mesh_size.py cat.geo 10212 2860

SetFactory("OpenCASCADE");

// Mesh sizes (m); -setnumber hs .. and -setnumber hi .. replace them.
DefineConstant[ hs = {0.034, Name "Parameters/skin size"} ];      // on the skin
DefineConstant[ hi = {0.035, Name "Parameters/interior size"} ];  // inside

parts() = {};
wires() = {};

// Loft a solid through elliptic sections.  L() holds 6 numbers per section:
// centre x, y, z; direction of the path in the xz plane (degrees);
// half height (in the xz plane, across the path); half width (along y).
Macro AddLoft
  W() = {};
  For i In {0:#L()/6-1}
    P() = {};
    ca = Cos(L(6*i+3)*Pi/180); sa = Sin(L(6*i+3)*Pi/180);
    For k In {0:7}
      u = L(6*i+4)*Cos(k*Pi/4); v = L(6*i+5)*Sin(k*Pi/4);
      q = newp;
      Point(q) = {L(6*i) - u*sa, L(6*i+1) + v, L(6*i+2) + u*ca};
      P() += {q};
    EndFor
    c = newl; Spline(c) = {P(), P(0)};
    wires() += {c};
    w = newll; Curve Loop(w) = {c};
    W() += {w};
  EndFor
  b = newv; ThruSections(b) = W();
  parts() += {b};
Return

// Ellipsoid: centre (ex, ey, ez), half axes (rx, ry, rz), tilted by et
// degrees about the y axis through its centre (nose down is positive).
Macro AddEllipsoid
  b = newv; Sphere(b) = {ex, ey, ez, 1};
  Rotate {{0, 1, 0}, {ex, ey, ez}, Pi/2} { Volume{b}; }  // seam below
  Dilate {{ex, ey, ez}, {rx, ry, rz}} { Volume{b}; }
  Rotate {{0, 1, 0}, {ex, ey, ez}, et*Pi/180} { Volume{b}; }
  parts() += {b};
Return

// Ear: a pyramid on a four-sided base, E() = 5 points (base 4, then tip).
Macro AddEar
  P() = {};
  For k In {0:4}
    q = newp; Point(q) = {E(3*k), sg*E(3*k+1), E(3*k+2)}; P() += {q};
  EndFor
  l = newl;
  For k In {0:3}
    Line(l+k) = {P(k), P((k+1)%4)};
    Line(l+4+k) = {P(k), P(4)};
  EndFor
  f = newll; Curve Loop(f) = {l, l+1, l+2, l+3};
  s = news; Plane Surface(s) = {f}; S() = {s};
  For k In {0:3}
    f = newll; Curve Loop(f) = {l+k, l+4+(k+1)%4, -(l+4+k)};
    s = news; Plane Surface(s) = {f}; S() += {s};
  EndFor
  f = newsl; Surface Loop(f) = S();
  b = newv; Volume(b) = {f};
  parts() += {b};
Return

// torso: rump to chest, back slightly arched
L() = {-0.515,0,0.490,0,0.042,0.042,  -0.480,0,0.482,0,0.090,0.085,
       -0.400,0,0.484,0,0.124,0.115,  -0.250,0,0.506,0,0.130,0.118,
       -0.050,0,0.516,0,0.122,0.112,   0.150,0,0.488,0,0.136,0.118,
        0.330,0,0.472,0,0.145,0.118,   0.440,0,0.484,0,0.122,0.100,
        0.500,0,0.497,0,0.075,0.068,   0.520,0,0.500,0,0.040,0.038};
Call AddLoft;
// neck
L() = {0.300,0,0.480,35,0.105,0.080,  0.400,0,0.560,40,0.115,0.090,
       0.490,0,0.645,45,0.100,0.088,  0.570,0,0.725,45,0.085,0.080};
Call AddLoft;
// head and muzzle
ex = 0.585; ey = 0; ez = 0.750; rx = 0.132; ry = 0.140; rz = 0.124; et = 10; Call AddEllipsoid;
ex = 0.675; ey = 0; ez = 0.708; rx = 0.074; ry = 0.078; rz = 0.058; et = 10; Call AddEllipsoid;
// tail
L() = {-0.400,0,0.510,172,0.055,0.055,  -0.540,0,0.522,172,0.048,0.048,
       -0.665,0,0.565,138,0.043,0.043,  -0.725,0,0.660,105,0.041,0.041,
       -0.740,0,0.780, 92,0.040,0.040,  -0.730,0,0.890, 78,0.039,0.039,
       -0.690,0,0.985, 55,0.038,0.038,  -0.620,0,1.040, 22,0.035,0.035,
       -0.592,0,1.048, 10,0.024,0.024};
Call AddLoft;
For side In {0:1}
  sg = 2*side - 1;  // -1 right, +1 left
  // ear
  E() = {0.635,0.018,0.830,  0.620,0.108,0.775,  0.530,0.108,0.775,  0.545,0.018,0.830,
         0.572,0.098,0.960};
  Call AddEar;
  // front leg and paw
  y = sg*0.085;
  L() = {0.340,sg*0.050,0.545,-90,0.070,0.035,  0.338,sg*0.070,0.450,-92,0.088,0.060,
         0.325,y,0.330,-90,0.064,0.054,         0.330,y,0.220,-88,0.050,0.048,
         0.338,y,0.110,-88,0.046,0.046,         0.342,y,-0.020,-90,0.046,0.046};
  Call AddLoft;
  ex = 0.385; ey = y; ez = 0.028; rx = 0.076; ry = 0.064; rz = 0.050; et = 0; Call AddEllipsoid;
  // hind leg, thigh and paw
  y = sg*0.090;
  L() = {-0.385,sg*0.050,0.545,-85,0.070,0.032,  -0.368,sg*0.072,0.430,-88,0.122,0.066,
         -0.345,y,0.325,-105,0.092,0.058,        -0.380,y,0.235,-125,0.058,0.051,
         -0.425,y,0.160,-112,0.049,0.047,        -0.435,y,0.090,-86,0.046,0.046,
         -0.438,y,-0.020,-90,0.046,0.046};
  Call AddLoft;
  ex = -0.384; ey = y; ez = 0.028; rx = 0.076; ry = 0.064; rz = 0.050; et = 0; Call AddEllipsoid;
EndFor

// one solid, cut flat at the ground
Recursive Delete { Curve{wires()}; }
one() = BooleanUnion{ Volume{parts(0)}; Delete; }{ Volume{parts({1:#parts()-1})}; Delete; };
g = newv; Box(g) = {-2, -2, -1, 4, 4, 1};
body() = BooleanDifference{ Volume{one()}; Delete; }{ Volume{g}; Delete; };
skin() = Boundary{ Volume{body()}; };
Physical Volume("body", 1) = {body()};
Physical Surface("skin", 1) = {skin()};

// sizes: hs on the skin, hi inside
Field[1] = MathEval; Field[1].F = Sprintf("%g", hs);
Field[2] = Restrict; Field[2].IField = 1; Field[2].SurfacesList = {skin()};
edges() = Boundary{ Surface{skin()}; };
Field[2].CurvesList = {Abs(edges())};
Field[3] = MathEval; Field[3].F = Sprintf("%g", hi);
Field[4] = Restrict; Field[4].IField = 3; Field[4].VolumesList = {body()};
Field[5] = Min; Field[5].FieldsList = {2, 4};
Background Field = 5;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;

General.NumThreads = 1;
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 2.2;
Mesh.Binary = 0;
Mesh.SaveAll = 0;
