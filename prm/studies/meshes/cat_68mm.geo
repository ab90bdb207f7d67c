// The cat of meshes/cat.geo with coarse cells: 1816 tetrahedra.
hs = 0.068;
hi = 0.07;
Include "../../../meshes/cat.geo";
