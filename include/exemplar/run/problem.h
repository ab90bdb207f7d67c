// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_h
#define exemplar_problem_h

#include <exemplar/algebra/conditioning.h>
#include <exemplar/base/step_clock.h>
#include <exemplar/body/example_weights.h>
#include <exemplar/body/handles.h>
#include <exemplar/body/loads.h>
#include <exemplar/body/mass.h>
#include <exemplar/body/supports.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/potential/inertia_term.h>
#include <exemplar/potential/load_term.h>
#include <exemplar/run/diagnostics.h>
#include <exemplar/run/inputs.h>
#include <exemplar/run/scene_parameters.h>
#include <exemplar/solvers/step_solver.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A scene made of its parts, in order of dependency. A part that the scene does
  /// not need is not there.
  class Problem
  {
  public:
    /// `inputs` are what read_inputs() gives, or arrays that a program hands in: then the scene
    /// needs no file. `clock` may run since the inputs are read. Throws UserError for whatever
    /// is no valid scene; writes nothing.
    Problem(SceneParameters scene, Inputs inputs, StepClock clock = StepClock(Part::read));

    /// Solve the next step from `state`, which is replaced if the solve succeeds.
    SolveReport
    advance();

    /// Go on from a state of an earlier run.
    void
    resume_from(const State &earlier, const std::string &solver_memory = "");

    /// What the solver remembers beside the state, for resume_from().
    std::string
    solver_memory() const;

    /// Of the systems that were solved last.
    Conditioning
    conditioning() const;

    /// Names of the parts that are there, or of those that are not.
    std::vector<std::string>
    parts(bool present) const;

    /// What each kind of part holds at present, in bytes; 0 for what is not there. UMFPACK does
    /// not tell, so there is no linear solver with it.
    std::vector<std::pair<std::string, std::size_t>>
    memory_of_parts() const;

    /// Warnings of all parts.
    std::vector<std::string>
    warnings() const;

    /// What looks wrong in the state that the last step has led to.
    std::vector<std::string>
    warnings_at_end() const;

    const SceneParameters parameters; ///< completed
    StepClock             clock;

    const TimeAxis                                    time_axis;
    const Mesh                                        mesh;
    const Material                                    material;
    const FESpace                                     fe_space;
    const std::unique_ptr<Handles>                    handles; ///< null without handles
    const std::optional<StaticallyDeterminateSupport> support; ///< of an interpolation
    const FreeDofs                                    free_dofs;
    const std::unique_ptr<Loads>                      loads;      ///< null without loads
    const std::unique_ptr<ExamplePoses>               examples;   ///< null without examples
    const std::unique_ptr<ExampleWeights>             weights;    ///< null without examples
    const std::unique_ptr<Mass>                       mass;       ///< null unless dynamic
    const std::unique_ptr<TimeIntegrator>             integrator; ///< null unless dynamic
    const std::vector<std::unique_ptr<PotentialTerm>> terms;   ///< beside the cells, in their order
    const SymmetricPattern                            pattern; ///< of the matrices
    ElasticPotential                                  elastic;
    IncrementalPotential                              potential;
    StepSystem                                        system;
    const std::unique_ptr<StepSolver>                 solver;
    Diagnostics                                       diagnostics;
    State                                             state;
    Evaluation                                        evaluation; ///< at the state

  private:
    std::vector<unsigned int>
    held_dofs() const;

    void
    check_supports() const;

    /// Whether the energy bound of doc/dynamics.md, Eq. (12), holds where handles rest.
    bool
    energy_is_bounded() const;

    /// Whether nothing acts on the body that the rest pose could not bear without strain.
    bool
    is_unloaded() const;

    /// Whether a rotation leaves the energy as it is.
    bool
    turns_freely() const;

    void
    start_interpolation();

    std::size_t
    quasi_newton_memory() const;

    std::size_t
    mass_memory() const;

    /// Evaluate at a state that no step has led to.
    void
    start(State &at);
  };
} // namespace Exemplar

#endif
