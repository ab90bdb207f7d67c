// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_body_h
#define exemplar_tests_body_h

#include <exemplar/body/example_poses.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/body/material.h>
#include <exemplar/body/model_parameters.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/patch_dilatation.h>
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

  /// find_grain_axes() without paint, whose warnings nobody reads.
  inline std::vector<GrainAxes>
  grain_axes_of(const MaterialParameters &parameters,
                const Mesh               &mesh,
                const NamedNodes         &named = {})
  {
    std::vector<std::string> warnings;
    return find_grain_axes(parameters, mesh, named, {}, warnings);
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

  /// What makes cells of that law: fibres along a curve, nine constants, a yield stress, a relaxation time.
  inline MaterialParameters
  material_of_law(const CellLaw law)
  {
    MaterialParameters parameters;
    parameters.everywhere.fibre_direction = "1; 0.3*x; 0.5-z";
    if (law == CellLaw::fibrous_plastic)
      parameters.everywhere.own["Yield stress"] = 2e4;
    if (law == CellLaw::viscoelastic)
      parameters.everywhere.own["Relaxation time"] = 0.3;
    if (law == CellLaw::fibrous || law == CellLaw::anisotropic || law == CellLaw::fibrous_plastic)
      parameters.everywhere.own["Fibre stiffness"] = 3e6;
    if (law == CellLaw::anisotropic)
    {
      parameters.everywhere.cross_direction = "0; 1; x";
      parameters.everywhere.orthotropy      = "3e6, 1e6, 5e5, 0.3, 0.4, 0.35, 2e5, 3e5, 4e5";
    }
    return parameters;
  }

  /// Examples and their weights; none by default.
  struct Examples
  {
    std::unique_ptr<ExamplePoses>   poses;
    std::unique_ptr<ExampleWeights> weights;

    const ExamplePoses *
    operator->() const
    {
      return poses.get();
    }

    std::vector<std::string>
    get_warnings() const
    {
      std::vector<std::string> all = poses->get_warnings();
      all.insert(all.end(), weights->get_warnings().begin(), weights->get_warnings().end());
      return all;
    }
  };

  /// An elastic body without anything that holds or solves it.
  struct Body
  {
    explicit Body(const MeshParameters     &mesh_parameters     = box_mesh(4., 4, 1),
                  const MaterialParameters &material_parameters = MaterialParameters(),
                  const Element             element             = Element::P1)
        : mesh(mesh_parameters), material(material_parameters, mesh.get_material_ids()),
          fe_space(mesh, element), cell_material(material)
    {
    }

    explicit Body(const MshFile            &contents,
                  const Element             element    = Element::P1,
                  const MaterialParameters &parameters = MaterialParameters(),
                  const NamedNodes         &named      = {})
        : mesh(contents, "test"),
          material(
              parameters, mesh.get_material_ids(), {}, {}, grain_axes_of(parameters, mesh, named)),
          fe_space(mesh, element), cell_material(material)
    {
    }

    /// Mean dilatation by patches from now on.
    void
    make_patches()
    {
      patches = Patches(Patches::choose(mesh, material, fe_space.element()), fe_space, material);
      cell_material = material.without_dilatation();
    }

    Examples
    examples(const ExampleParameters &parameters,
             const LawsOfCells       &laws = CellLaw::corotational) const
    {
      Examples result;
      result.poses = std::make_unique<ExamplePoses>(parameters, laws, mesh, fe_space, cell_material,
                                                    patches);
      result.weights = std::make_unique<ExampleWeights>(parameters, *result.poses,
                                                        unit_energy(fe_space, material),
                                                        TimeAxis::of_increments(TimeParameters()));
      return result;
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

    /// At rest, then drawn along x and across, and a little disturbed.
    Vector
    drawn(const double length, const double thickness, const unsigned int seed) const
    {
      std::mt19937 generator(seed);
      Vector       positions = random_positions(generator, 0.01);
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        positions[dof] *= dof % 3 == 0 ? length : thickness;
      return positions;
    }

    /// At rest, but for what is nearer than x to the end at 0, which is mirrored through that plane.
    Vector
    with_mirrored_end(const double x) const
    {
      Vector positions = fe_space.rest_positions();
      for (unsigned int dof = 0; dof < positions.size(); dof += 3)
        if (positions[dof] < x)
          positions[dof] += 1.9 * (x - positions[dof]);
      return positions;
    }

    const Mesh     mesh;
    const Material material;
    const FESpace  fe_space;
    Material       cell_material;
    Patches        patches; ///< none: cells know their own dilatation
  };

  /// What a potential refers to, made before it.
  struct MatrixPattern
  {
    SymmetricPattern matrix_pattern;
    Examples         none;
  };

  /// How a body is divided.
  struct Discretisation
  {
    Element element;
    bool    has_patches;
  };

  inline NodePairs
  couplings_of(const Body &body)
  {
    if (body.patches.size() == 0)
      return {};
    return PatchScatter::couplings(body.patches, body.fe_space);
  }

  inline const Patches &
  no_patches()
  {
    static const Patches none;
    return none;
  }

  /// The elastic potential of a body.
  class BodyPotential : public MatrixPattern, public ElasticPotential
  {
  public:
    BodyPotential(const Body            &body,
                  const ModelParameters &model,
                  const Examples        &examples,
                  const FreeDofs        &free_dofs)
        : BodyPotential(body, LawsOfCells(model.law()), examples, free_dofs)
    {
    }

    BodyPotential(const Body        &body,
                  const LawsOfCells &laws,
                  const Examples    &examples,
                  const FreeDofs    &free_dofs)
        : MatrixPattern{ Exemplar::make_pattern(body.fe_space, couplings_of(body), free_dofs),
                         body.examples(ExampleParameters()) },
          ElasticPotential({ laws, body.fe_space, body.material, body.cell_material, body.patches,
                             *given(examples).poses, *given(examples).weights, free_dofs })
    {
      attach(matrix_pattern);
    }

    /// From now on the pattern is that of the cells.
    void
    assemble_in_parts()
    {
      matrix_pattern = ElasticPotential::make_pattern({}, true);
      attach(matrix_pattern);
    }

    ElasticEvaluation
    evaluate_at(const Vector &x, const std::vector<double> &weights = {})
    {
      ElasticEvaluation evaluation;
      evaluate(x, weights, evaluation, RotationUse::update);
      return evaluation;
    }

  private:
    const Examples &
    given(const Examples &examples) const
    {
      return examples.poses == nullptr ? none : examples;
    }
  };
} // namespace Exemplar::Testing

#endif
