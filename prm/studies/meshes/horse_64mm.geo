// The horse of meshes/horse.geo with coarse cells: 2884 tetrahedra.
hs = 0.0635;
hi = 0.0872;
Include "../../../meshes/horse.geo";
