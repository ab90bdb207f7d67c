// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_body_h
#define exemplar_tests_body_h

#include <exemplar/body/example_poses.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/potential/assembler.h>
#include <exemplar/potential/inertia.h>
#include <exemplar/verification/verification_scene.h>

#include <memory>
#include <random>

namespace Exemplar::Testing
{
  inline MeshParameters
  box_mesh(const double length, const unsigned int nx, const unsigned int n)
  {
    MeshParameters parameters;
    parameters.generator = MeshGenerator::box;
    parameters.box_size  = { { length, 1., 1. } };
    parameters.box_cells = { { nx, n, n } };
    return parameters;
  }

  /// The bar 4 x 1 x 1 twisted by an angle over its length, as a pose function.
  inline std::string
  twist(const double degrees)
  {
    return Verification::twist(degrees, 4.);
  }

  /// A bar of which the cells with their centroid beyond x = `border` are material 2,
  /// the others 1.
  inline MshFile
  bar_of_two_regions(const double border, const MeshParameters &bar = box_mesh(4., 8, 1))
  {
    MshFile contents = Mesh(bar).get_contents();
    for (MshElement &element : contents.elements)
      if (element.type == MshElementType::tetrahedron)
      {
        double x = 0.;
        for (const std::size_t node : element.nodes)
          x += 0.25 * contents.nodes[node][0];
        element.physical = x < border ? 1 : 2;
      }
    return contents;
  }

  /// An elastic body without anything that holds or solves it.
  struct Body
  {
    explicit Body(const MeshParameters     &mesh_parameters     = box_mesh(4., 4, 1),
                  const MaterialParameters &material_parameters = MaterialParameters())
        : mesh(mesh_parameters), material(material_parameters, mesh.get_material_ids()),
          fe_space(mesh)
    {
    }

    explicit Body(const MshFile &contents)
        : mesh(contents, "test"), material(MaterialParameters(), mesh.get_material_ids()),
          fe_space(mesh)
    {
    }

    std::unique_ptr<ExamplePoses>
    examples(const ExampleParameters &parameters,
             const StrainMeasure      measure = StrainMeasure::corotational) const
    {
      return std::make_unique<ExamplePoses>(parameters, measure, mesh, fe_space, material,
                                            TimeAxis::of_increments(TimeParameters()));
    }

    dealii::Vector<double>
    random_positions(std::mt19937 &generator, const double amplitude) const
    {
      std::normal_distribution<double> normal;
      dealii::Vector<double>           positions = fe_space.rest_positions();
      for (double &x : positions)
        x += amplitude * normal(generator);
      return positions;
    }

    const Mesh     mesh;
    const Material material;
    const FESpace  fe_space;
  };
} // namespace Exemplar::Testing

#endif
