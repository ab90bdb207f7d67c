// The horse of meshes/horse.geo with fine cells: 12462 tetrahedra.
hs = 0.034;
hi = 0.0467;
Include "../../../meshes/horse.geo";
