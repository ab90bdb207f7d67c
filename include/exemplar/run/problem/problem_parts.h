// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_parts_h
#define exemplar_problem_parts_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/handles.h>
#include <exemplar/body/loads.h>
#include <exemplar/body/mass.h>
#include <exemplar/body/supports.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/obstacles/body_contacts.h>
#include <exemplar/obstacles/contact_surface.h>
#include <exemplar/obstacles/obstacles.h>
#include <exemplar/obstacles/ties.h>
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/potential/initial_stress_term.h>
#include <exemplar/run/inputs/body_inputs.h>
#include <exemplar/run/problem/example_start.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

// The parts of a problem, grouped by dependency. Pointers are null if a scene does not need the
// part.

namespace Exemplar
{
  TimeAxis
  make_time_axis(const SceneParameters &parameters);

  /// The elastic body at rest.
  struct Body
  {
    /// Moves the mesh out of the inputs.
    Body(const SceneParameters &parameters, BodyInputs &inputs);

    /// Communication with the processes that have other parts of the body.
    const Exchange &
    exchange() const
    {
      return mesh.exchange();
    }

    /// Update after a change of the material.
    void
    follow_material();

    const Mesh    mesh;
    Material      material; ///< C, or C' of Eq. (38)
    const FESpace fe_space;
    const Ties    ties;          ///< between pieces; none without Ties/Names
    Patches       patches;       ///< regions of one mean dilatation; none: by cell
    Material      cell_material; ///< for the cells' own energy
    /// Report on mesh and poses made of surfaces; null if none were.
    const std::shared_ptr<const MadeOfSurfaces> made;
    /// Walls around gmsh's geometry, see MshFile::geo_walls.
    const std::optional<std::vector<std::string>> geo_walls;
    const std::vector<std::string>                warnings; ///< of reading off the surface
    const std::shared_ptr<const SurfaceMesh>      surface;  ///< null unless it is needed
    const std::vector<CarriedSurface>             carried;  ///< of Mesh/Carry
    const std::shared_ptr<const Inputs> inputs; ///< null unless Output/Space error needs them
    const std::vector<WeightRegion>     weight_regions; ///< of Examples/Regions = auto; at the root
  };

  /// The constraints of the body, and its free degrees of freedom.
  struct Constraints
  {
    /// Throws UserError for invalid handles, and if all degrees of freedom are held.
    Constraints(const SceneParameters &parameters,
                const Body            &body,
                const TimeAxis        &axis,
                const BodyInputs      &inputs);

    /// Throws UserError for a static scene in which the body can move rigidly in a step of the
    /// axis.
    void
    check(const SceneParameters &parameters, const Body &body, const TimeAxis &axis);

    /// Let `change` alter which nodes handles hold. Throws UserError, with nothing changed, if that
    /// holds all degrees of freedom or, in statics, leaves the body free to move rigidly. All
    /// processes must call this.
    void
    change_handles(const std::function<void(Handles &)> &change,
                   const SceneParameters                &parameters,
                   const Body                           &body);

    /// Let handles with From or Until hold as in a step that begins at this time [s]. Returns
    /// whether that changes the held nodes. All processes must call this.
    bool
    follow_time(double time, const SceneParameters &parameters, const Body &body);

    /// A warning of each handle of one node, and how to enlarge it. All processes must call this.
    std::vector<std::string>
    describe_single_nodes(const Body &body) const;

    /// Sentences, with a remedy, on moving handles whose box or sphere contains just one node. All
    /// processes must call this.
    std::vector<std::string>
    describe_pulled_nodes(const SceneParameters &parameters, const Body &body) const;

    Handles                                           handles;
    const std::optional<StaticallyDeterminateSupport> support; ///< if an interpolation
    FreeDofs                                          free_dofs;
    HeldTips
        held_tips; ///< of the normals of a shell with slopes, as free_dofs has them; else empty

  private:
    /// Set free_dofs and held_tips. Throws UserError, with nothing changed, if nothing is free.
    void
    follow_handles(const SceneParameters &parameters, const Body &body);

    void
    check_rigid_motions(const SceneParameters &parameters, const Body &body) const;
  };

  /// The example poses and the rule of their weights; both empty in a scene without examples.
  struct Examples
  {
    Examples(const SceneParameters &parameters,
             const Body            &body,
             const TimeAxis        &axis,
             const BodyInputs      &inputs);

    ExamplePoses              poses;
    ExampleWeights            weights;
    std::vector<ExampleStart> starts; ///< of the scene's last step, with Solver/Starts = examples
  };

  /// The law of each cell: those with a yield stress are plastic. All processes must call this.
  LawsOfCells
  laws_of_cells(const SceneParameters &parameters, const Body &body);

  /// The cells of a scene's body, with these weights of its examples and these degrees of freedom. All must outlive what
  /// is made of it. All processes must call this.
  ElasticParts
  elastic_parts(const SceneParameters &parameters,
                const Body            &body,
                const ExamplePoses    &poses,
                ExampleWeights        &weights,
                const FreeDofs        &free_dofs);

  /// The body of a scene: its cells, or the triangles of a shell; as above.
  std::unique_ptr<ElasticBody>
  make_elastic_body(const SceneParameters &parameters,
                    const Body            &body,
                    const ExamplePoses    &poses,
                    ExampleWeights        &weights,
                    const Constraints     &constraints);

  /// Makes a user-defined term. Called for each potential: that of the steps, and that of a
  /// Laboratory, which copies the state of the term by PotentialTerm::save() and load().
  using MakeTerm = std::function<std::unique_ptr<PotentialTerm>()>;

  /// A term added by a program.
  struct OwnTerm
  {
    MakeTerm             make;
    const PotentialTerm *term; ///< the one in the potential of the steps
  };

  /// Loads and inertia of the body, and what it may not pass.
  struct Actions
  {
    Actions(const SceneParameters &parameters, const Body &body, const BodyInputs &inputs);

    /// Append the terms of obstacles, and of the springs that constrain what obstacles leave free in statics. The integrator is
    /// null unless the scene is dynamic.
    void
    append_obstacle_terms(const Body           &body,
                          const TimeIntegrator *integrator_of_terms,
                          PotentialTerms       &terms) const;

    /// The terms of the potential for these, with the elastic body that initial stresses act in, and this time integrator, which is
    /// null unless the scene is dynamic.
    PotentialTerms
    make_terms(const Body           &body,
               ElasticBody          *elastic,
               const TimeIntegrator *integrator_of_terms) const;

    std::unique_ptr<Loads>                loads;
    const std::unique_ptr<Mass>           mass;       ///< in dynamic scenes
    const std::unique_ptr<TimeIntegrator> integrator; ///< in dynamic scenes
    std::unique_ptr<Obstacles>            obstacles;
    std::unique_ptr<BodyContacts>         body_contacts;    ///< with Contact/Self or Bodies
    std::unique_ptr<ContactSurface>       contact_surface;  ///< with obstacles or these
    PointStresses                         initial_stresses; ///< empty unless the body is balanced
    std::vector<double>                   held_tensions;    ///< see FibreTensionTerm
    std::vector<OwnTerm>                  own_terms;        ///< in order of addition
    std::vector<std::string>              warnings;         ///< of all but own_terms
    std::vector<std::string>              notes;            ///< of obstacles that were set back

    /// Whether the energy bound of doc/dynamics.md, Eq. (12), holds while handles rest.
    const bool energy_is_bounded;
  };

  /// Whether matrix and outer products are always assembled apart: if multigrid is certain to be
  /// chosen, with so many weights at most.
  bool
  is_assembled_in_parts(const SolverParameters &solver,
                        const FESpace          &fe_space,
                        unsigned int            n_weights);

  /// The bordered system of a step with the linear solver of the scene or, if that is automatic,
  /// the faster one; adapts the potential's sparsity pattern to it.
  std::unique_ptr<BorderedSystem>
  make_bordered_system(const SolverParameters &solver, IncrementalPotential &potential);
} // namespace Exemplar

#endif
