// The cat of meshes/cat.geo with fine cells: 22896 tetrahedra.
hs = 0.0255;
hi = 0.0263;
Include "../../../meshes/cat.geo";
