// A standing horse, one solid.  Units: m.  Facing +x, up +z, left +y (its right
// side is y < 0); the hooves are flat at z = 0; shape symmetric in y about 0 (the
// mesh is not).  Chest to rump about 1.06 m.
// Extents: x -0.69 .. 0.98, y -0.18 .. 0.18, z 0 .. 1.49.
//   fore hooves centre ( 0.382, -+0.105, 0)   sole x  0.32 ..  0.44
//   hind hooves centre (-0.411, -+0.105, 0)   sole x -0.47 .. -0.35
//   head        from the poll (0.69, 0, 1.39) to the muzzle (0.96, 0, 1.05);
//               ear tips (0.722, -+0.050, 1.490)
//   tail        root (-0.50, 0, 0.87), hangs at x = -0.63, tip (-0.636, 0, 0.40)
// Made with gmsh 4.8.4 by
//   gmsh -3 horse.geo -o horse.msh
// giving 6185 tetrahedra and 1997 nodes; to fit hs and hi again:
//   fit_mesh_size.py horse.geo 6203 2001

SetFactory("OpenCASCADE");

// Mesh sizes (m); -setnumber hs .. and -setnumber hi .. replace them.
DefineConstant[ hs = {0.04539, Name "Parameters/skin size"} ];      // on the skin
DefineConstant[ hi = {0.06232, Name "Parameters/interior size"} ];  // inside

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

// torso: rump to chest
L() = {-0.530,0,0.800,0,0.050,0.045,  -0.490,0,0.805,0,0.115,0.100,
       -0.380,0,0.795,0,0.185,0.155,  -0.180,0,0.780,0,0.185,0.160,
        0.050,0,0.768,0,0.192,0.162,   0.220,0,0.776,0,0.210,0.155,
        0.360,0,0.780,0,0.195,0.142,   0.460,0,0.790,0,0.145,0.110,
        0.510,0,0.800,0,0.080,0.065,   0.528,0,0.802,0,0.045,0.040};
Call AddLoft;
// neck, with the crest of the mane
L() = {0.250,0,0.790,30,0.170,0.095,  0.400,0,0.930,45,0.170,0.098,
       0.530,0,1.080,50,0.135,0.084,  0.620,0,1.205,52,0.108,0.075,
       0.665,0,1.262,52,0.085,0.066,  0.700,0,1.305,52,0.052,0.048};
Call AddLoft;
// head
L() = {0.665,0,1.354,-42,0.045,0.045,  0.685,0,1.330,-44,0.092,0.074,
       0.740,0,1.270,-46,0.108,0.078,  0.810,0,1.197,-47,0.082,0.064,
       0.870,0,1.133,-48,0.064,0.055,  0.920,0,1.080,-50,0.064,0.058,
       0.950,0,1.047,-52,0.040,0.038};
Call AddLoft;
// tail
L() = {-0.430,0,0.860,165,0.055,0.050,  -0.530,0,0.870,190,0.050,0.046,
       -0.590,0,0.820,235,0.050,0.048,  -0.620,0,0.730,260,0.056,0.054,
       -0.632,0,0.600,267,0.060,0.058,  -0.636,0,0.480,270,0.052,0.050,
       -0.636,0,0.400,270,0.030,0.030};
Call AddLoft;
For side In {0:1}
  sg = 2*side - 1;  // -1 right, +1 left
  // ear
  E() = {0.775,0.008,1.330,  0.775,0.048,1.300,  0.705,0.048,1.300,  0.705,0.008,1.330,
         0.722,0.050,1.490};
  Call AddEar;
  // front leg
  y = sg*0.105;
  L() = {0.350,sg*0.060,0.850,-90,0.085,0.045,  0.350,sg*0.085,0.700,-90,0.115,0.070,
         0.345,y,0.560,-90,0.078,0.062,         0.350,y,0.450,-90,0.058,0.052,
         0.355,y,0.340,-90,0.054,0.050,         0.350,y,0.230,-90,0.043,0.042,
         0.350,y,0.135,-86,0.046,0.045,         0.363,y,0.080,-78,0.049,0.048,
         0.382,y,0.000,-90,0.060,0.057};
  Call AddLoft;
  // hind leg
  y = sg*0.105;
  L() = {-0.370,sg*0.060,0.860,-85,0.100,0.045,  -0.325,sg*0.085,0.720,-90,0.118,0.080,
         -0.345,y,0.590,-100,0.118,0.072,        -0.395,y,0.480,-112,0.080,0.058,
         -0.445,y,0.370,-105,0.060,0.052,        -0.452,y,0.250,-88,0.045,0.044,
         -0.445,y,0.145,-84,0.047,0.046,         -0.430,y,0.082,-78,0.049,0.048,
         -0.411,y,0.000,-90,0.060,0.057};
  Call AddLoft;
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
