// The cat of meshes/cat.geo with coarse cells: 4171 tetrahedra.
hs = 0.0476;
hi = 0.049;
Include "../../../meshes/cat.geo";
