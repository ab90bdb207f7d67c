// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_parts_h
#define exemplar_problem_parts_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/handles.h>
#include <exemplar/body/loads.h>
#include <exemplar/body/mass.h>
#include <exemplar/body/supports.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/potential/initial_stress_term.h>
#include <exemplar/run/inputs/body_inputs.h>
#include <exemplar/run/problem/example_start.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

// The parts of a problem, grouped as they depend on each other. Pointers are null where a scene
// does not need the part.

namespace Exemplar
{
  TimeAxis
  make_time_axis(const SceneParameters &parameters);

  /// The elastic body at rest.
  struct Body
  {
    /// Takes the mesh of the inputs.
    Body(const SceneParameters &parameters, BodyInputs &inputs);

    /// With the processes that have other parts of the body.
    const Exchange &
    exchange() const
    {
      return mesh.exchange();
    }

    /// After a change of the material.
    void
    follow_material();

    const Mesh    mesh;
    Material      material; ///< of examples with an elasticity of their own the sum with it
    const FESpace fe_space;
    Patches       patches;       ///< of one mean dilatation each; none: cells know their own
    Material      cell_material; ///< of the cells' own energy
    /// How the mesh and its poses became of surfaces; null if none did.
    const std::shared_ptr<const MadeOfSurfaces> made;
    /// What stood around gmsh, see MshFile::geo_walls.
    const std::optional<std::vector<std::string>> geo_walls;
    const std::vector<std::string>                warnings; ///< of the making
    const std::shared_ptr<const SurfaceMesh>      surface;  ///< null unless it is needed
    const std::vector<CarriedSurface>             carried;  ///< of Mesh/Carry
    const std::shared_ptr<const Inputs> inputs; ///< null unless Output/Space error needs them
  };

  /// What holds the body, and what is left free.
  struct Constraints
  {
    /// Throws UserError for handles that are none, or that hold everything.
    Constraints(const SceneParameters &parameters,
                const Body            &body,
                const TimeAxis        &axis,
                const BodyInputs      &inputs);

    /// Throws UserError for a static scene in which the body could move rigidly, in a step of the axis.
    void
    check(const SceneParameters &parameters, const Body &body, const TimeAxis &axis);

    /// Let `change` change which nodes handles hold. Throws UserError, with nothing changed, for what
    /// would hold everything or, in statics, leave the body free to move rigidly. All processes must
    /// call this.
    void
    change_handles(const std::function<void(Handles &)> &change,
                   const SceneParameters                &parameters,
                   const Body                           &body);

    /// Let handles with a time hold as they do in a step that begins at this time [s]. Returns whether
    /// that changes what is held. All processes must call this.
    bool
    follow_time(double time, const SceneParameters &parameters, const Body &body);

    /// A warning of each handle of one node, and how to enlarge it. All processes must call this.
    std::vector<std::string>
    describe_single_nodes(const Body &body) const;

    /// Handles that pull at the one node that a box or a sphere happens to hold, in sentences with the
    /// remedy. All processes must call this.
    std::vector<std::string>
    describe_pulled_nodes(const SceneParameters &parameters, const Body &body) const;

    Handles                                           handles;
    const std::optional<StaticallyDeterminateSupport> support; ///< of an interpolation
    FreeDofs                                          free_dofs;

  private:
    void
    check_rigid_motions(const SceneParameters           &parameters,
                        const Body                      &body,
                        const std::vector<unsigned int> &held) const;
  };

  /// The example poses and the rule of their weights; both empty in a scene without examples.
  struct Examples
  {
    Examples(const SceneParameters &parameters,
             const Body            &body,
             const TimeAxis        &axis,
             const BodyInputs      &inputs);

    ExamplePoses   poses;
    ExampleWeights weights;
    std::vector<ExampleStart>
        starts; ///< of the last step of the scene, with Solver/Starts = examples
  };

  /// The law of each cell: those with a yield stress are plastic. All processes must call this.
  LawsOfCells
  laws_of_cells(const SceneParameters &parameters, const Body &body);

  /// Makes a term of one's own. It is called for each potential that needs one: that of the steps, and
  /// that of a Laboratory, whose term gets what the other remembers by PotentialTerm::save() and load().
  using MakeTerm = std::function<std::unique_ptr<PotentialTerm>()>;

  /// A term that a program has added.
  struct OwnTerm
  {
    MakeTerm             make;
    const PotentialTerm *term; ///< that of the steps
  };

  /// What acts on the body beside its elasticity.
  struct Actions
  {
    Actions(const SceneParameters &parameters, const Body &body, const BodyInputs &inputs);

    /// The terms of the potential that stand for them, by this time integrator, which is null unless the
    /// scene is dynamic.
    PotentialTerms
    make_terms(const Body &body, const TimeIntegrator *integrator_of_terms) const;

    std::unique_ptr<Loads>                loads;
    const std::unique_ptr<Mass>           mass;             ///< in dynamic scenes
    const std::unique_ptr<TimeIntegrator> integrator;       ///< in dynamic scenes
    PointStresses                         initial_stresses; ///< empty unless the body is balanced
    std::vector<OwnTerm>                  own_terms;        ///< first come first
    std::vector<std::string>              warnings;         ///< of all but these

    /// Whether the energy bound of doc/dynamics.md, Eq. (12), holds where handles rest.
    const bool energy_is_bounded;
  };

  /// Whether the matrix keeps outer products apart at first: where multigrid is sure to be chosen.
  bool
  is_assembled_in_parts(const SolverParameters &solver, const Exchange &exchange);

  /// The bordered system of a step with the linear solver that a scene asks for or, if it leaves
  /// the choice, the faster one; the potential's pattern becomes one for it.
  std::unique_ptr<BorderedSystem>
  make_bordered_system(const SolverParameters &solver, IncrementalPotential &potential);
} // namespace Exemplar

#endif
