// A teapot of 80 mm: round body, spout, handle (with a hole to put a finger through), lid knob; and the air
// around it. Millimetres here; the mesh is scaled to metres.
SetFactory("OpenCASCADE");

Sphere(1) = {0, 0, 0, 24};
Cylinder(2) = {0, 0, -26, 0, 0, 10, 14};               // foot
Sphere(3) = {0, 0, 26, 5};                             // knob of the lid
Cone(4) = {16, 0, -4, 24, 0, 20, 8, 3.5};              // spout
Torus(5) = {-24, 0, 1, 13, 4};                         // handle, turned upright below
Rotate {{1, 0, 0}, {-24, 0, 1}, Pi/2} { Volume{5}; }
BooleanUnion(10) = { Volume{1}; Delete; }{ Volume{2:5}; Delete; };

Box(20) = {-61, -44, -42, 121, 88, 93};                // about 20 mm of air on every side
BooleanFragments{ Volume{20}; Delete; }{ Volume{10}; Delete; }

inside() = Volume In BoundingBox {-45, -30, -30, 45, 30, 40};
outside() = Volume{:};
outside() -= {inside()};
Physical Volume("inside", 1) = {inside()};
Physical Volume("outside", 2) = {outside()};

surface() = Abs(Boundary{ Volume{inside()}; });
Field[1] = Distance;
Field[1].SurfacesList = {surface()};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = 5;
Field[2].SizeMax = 16;
Field[2].DistMin = 1;
Field[2].DistMax = 18;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Mesh.Algorithm = 6;         // frontal Delaunay on surfaces
Mesh.Algorithm3D = 1;       // Delaunay
Mesh.Optimize = 1;
Mesh.RandomSeed = 1;
Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 0;
