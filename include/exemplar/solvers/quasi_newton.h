// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_quasi_newton_h
#define exemplar_quasi_newton_h

#include <exemplar/algebra/lbfgs.h>
#include <exemplar/solvers/contact_model.h>
#include <exemplar/solvers/motion_prediction.h>
#include <exemplar/solvers/newton.h>
#include <exemplar/solvers/rotated_metric.h>
#include <exemplar/solvers/staged_motion.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// Steps of dynamics that seldom factorise: the exact gradient, and for the inverse of its
  /// derivative the inverse of an earlier tangent, rotated with the nodes and corrected by L-BFGS,
  /// whose pairs are kept in the frame of that inverse and so stay good for many steps. Newton's
  /// method takes over where that does not converge. doc/solver.md, "Steps without a
  /// factorisation".
  class QuasiNewton : public StepSolver
  {
  public:
    QuasiNewton(const SolverParameters &parameters,
                IncrementalPotential   &potential,
                StepSystem             &system,
                const Handles          &handles,
                StepClock              &clock);

    SolveReport
    solve(State &state, Evaluation &evaluation, double time, double step_size) override;

    void
    forget() override;

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    const dealii::FullMatrix<double> &
    schur_complement() const override
    {
      return metric.empty() ? system.bordered().schur_complement() : metric.schur_complement();
    }

    std::size_t
    memory_consumption() const override;

  private:
    /// Where a metric was made.
    struct MetricOrigin
    {
      Vector              positions; ///< [m]
      std::vector<double> weights;   ///< then, which some convex tangents know
      NodePairs           couplings; ///< of terms, then
      State               start; ///< of the step, if the energy changes between steps; else empty
      double              time        = 0.; ///< of that step's end [s]
      double              step_size   = 0.; ///< [s]
      double              mass_factor = 0.; ///< IncrementalPotential::mass_factor() then
    };

    /// Where the metric was made, and how it has served since. Copies share the origin.
    struct MetricHistory
    {
      std::shared_ptr<const MetricOrigin> made;                ///< null: none was made
      unsigned int                        steps           = 0; ///< since then
      unsigned int                        iterations      = 0; ///< in these steps
      unsigned int                        last_iterations = 0; ///< in the last of them
      unsigned int contact_steps = 0, contact_iterations = 0;  ///< of those in which gaps mattered
      bool         last_in_contact = false;

      double
      mass_factor() const
      {
        return made ? made->mass_factor : 0.;
      }

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        MetricOrigin origin = made ? *made : MetricOrigin();
        archive &origin.positions &origin.weights &origin.couplings &origin.start &origin
            .time &origin.step_size &origin.mass_factor &steps &iterations &last_iterations
                &contact_steps &contact_iterations &last_in_contact;
        made = origin.positions.size() > 0 ? std::make_shared<const MetricOrigin>(std::move(origin))
                                           : nullptr;
      }
    };

    /// What a step that is abandoned restores, in addition to pairs and velocities.
    struct KeptHistory
    {
      MetricHistory history, next;
    };

    /// A step of the method, and what has been seen of the steps before it.
    struct Iteration
    {
      std::vector<double> gradient; ///< by free degree of freedom, at the trial
      std::vector<double>
          contact; ///< the part of the gradient that gaps make; empty where none pushes
      std::vector<double> direct;                         ///< the displacement
      std::vector<double> rotated;                        ///< the same in the frame of the metric
      std::unique_ptr<ContactModel::AlongDirection> gaps; ///< along it; null where none matters
      double                                        last_length      = 0.;
      double                                        last_contraction = 0.;
      bool is_nearly_there = false; ///< has_arrived() but for a larger tolerance
    };

    /// Vectors of a step, which stay from one step to the next for their memory alone.
    struct Memory
    {
      State               trial;
      Iteration           iteration;
      std::vector<double> old_gradient, old_contact, old_weights;
      Vector              displacement;
      std::vector<float>  node_rotations;
    };

    /// Remember what save() would write now.
    void
    keep();

    /// To the last keep(), after predict().
    void
    go_back();

    /// The step itself. Throws Interrupted, with a memory of half a step.
    SolveReport
    solve_or_hand_over(State &state, Evaluation &evaluation, double time, double step_size);

    /// report_iteration(). Throws Interrupted if the step is to be abandoned.
    void
    report_or_stop(State &trial, const Evaluation &evaluation, SolveReport &report) const;

    void
    predict(const State &accepted, double step_size, State &trial, Evaluation &evaluation);

    /// Have a metric, with the nodes as they are where the step starts.
    void
    begin_with_metric(const State &start, double step_size);

    void
    make_metric(const Vector &positions, const std::vector<double> &weights);

    void
    renew_metric(const State &start, double step_size, const State &trial);

    MetricHistory
    new_history(const State &start, double step_size, const State &trial) const;

    /// Whether terms couple other nodes than they did where the metric was made.
    bool
    has_other_couplings() const;

    /// Whether so many steps have gone by as take as long as a metric, by counts.
    bool
    is_next_due() const;

    /// Let a thread make the next metric, if it does not already; false if none may.
    bool
    begin_next_metric(const State &start, double step_size, const State &trial);

    /// The thread's part of that: of the tangent there, with the rotations as they are.
    bool
    begin_factor(const Vector &positions, const std::vector<double> &weights);

    void
    take_next_metric();

    /// Whether the last step took more iterations than steps like it since the metric was made, its cost included. Contact
    /// takes iterations that another metric would not save. Of a body that does not keep its tangent: also whether that step
    /// had to make the metric on its way.
    bool
    is_slow() const;

    /// Whether a metric is to be replaced within the step, because it would take more iterations to the tolerance, at the rate of the
    /// last one, than another costs. Of a body that does not keep its tangent alone.
    bool
    should_have_another(double residual, double gradient_ratio) const;

    /// So many iterations with one metric a step may take without contact before it makes another.
    unsigned int
    most_iterations() const;

    /// A step has ended, or the part of one that the metric was good for.
    void
    count_step(const SolveReport &report);

    /// Have a metric for this step: the last, or a new one if that has become slow.
    void
    find_metric(const State &start, double step_size, const State &trial);

    /// After a resume: rotations are functions of the positions.
    void
    rebuild_metrics(const State &accepted, double step_size, double time);

    /// Turn the metric with the nodes of the trial, if they have turned since that was done last.
    void
    turn_metric();

    /// Gather the gradient at the trial, and the part of it that gaps make.
    void
    measure(const State &trial, const Evaluation &evaluation, Iteration &iteration) const;

    /// Find the step at the trial; returns the slope along it.
    double
    find_step(const State &trial, const Evaluation &evaluation, Iteration &iteration);

    /// What a part of the step along which the potential has that slope should change it by.
    double
    expected_change(const Iteration &iteration, double slope, double length) const;

    /// The slope of the potential along a step at the place of an evaluation.
    double
    slope_along(const std::vector<double> &step, const Evaluation &evaluation) const;

    /// Go along the step; false, with the trial back at its beginning, if nothing goes downhill.
    bool
    take_step(double slope, State &trial, Evaluation &evaluation, SolveReport &report);

    /// Keep the pair of the last step and the change of forces that it has made, without those of gaps. `change` holds
    /// the gradient before the step; it, `old_weights` and the rotated step are overwritten. `old_contact` is what gaps
    /// made of that gradient.
    void
    learn(const State               &trial,
          const std::vector<double> &old_contact,
          std::vector<double>       &old_weights,
          std::vector<double>       &change,
          double                     step_length,
          Iteration                 &iteration);

    /// Whether the steps show that the trial is near enough to where they lead.
    bool
    has_arrived(const State       &accepted,
                const State       &trial,
                const SolveReport &report,
                double             gradient_ratio,
                Iteration         &iteration) const;

    void
    iterate(const State &accepted,
            double       step_size,
            State       &trial,
            Evaluation  &evaluation,
            SolveReport &report);

    const SolverParameters parameters;
    IncrementalPotential  &potential;
    StepSystem            &system;
    StepClock             &clock;
    Newton                 newton; ///< where this method does not converge
    MotionPrediction       prediction;
    StagedMotion           motion;
    Memory                 memory;
    RotatedMetric          metric;
    std::vector<float>     node_rotations;
    Lbfgs                  lbfgs; ///< in the frame of the metric
    ContactModel           contact;
    MetricHistory          history;
    bool                   in_contact = false; ///< whether gaps have mattered in this step
    MetricHistory          next;           ///< of the metric that a thread makes, if there is one
    KeptHistory            kept;           ///< where the step began
    std::vector<float>     next_rotations; ///< of the nodes where it was assembled
  };
} // namespace Exemplar

#endif
