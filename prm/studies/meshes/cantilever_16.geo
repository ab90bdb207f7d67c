// A beam 10 x 1/4 x 1, 16 cells over its height: ids 1 and 2 are the ends, 3 both sides.
n = 16;
Point(1) = {0, 0, -0.5};
line[] = Extrude {0, 0, 1} { Point{1}; Layers{n}; };
face[] = Extrude {10, 0, 0} { Line{line[1]}; Layers{10*n}; };
body[] = Extrude {0, 0.25, 0} { Surface{face[1]}; Layers{1}; };
Physical Volume(1) = body[1];
eps = 1e-6;
Physical Surface(1) = Surface In BoundingBox {-eps, -eps, -0.5-eps, eps, 0.25+eps, 0.5+eps};
Physical Surface(2) = Surface In BoundingBox {10-eps, -eps, -0.5-eps, 10+eps, 0.25+eps, 0.5+eps};
Physical Surface(3) = {face[1], body[0]};
