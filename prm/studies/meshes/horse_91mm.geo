// The horse of meshes/horse.geo with coarse cells: 1274 tetrahedra.
hs = 0.0908;
hi = 0.1246;
Include "../../../meshes/horse.geo";
