// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_potential_term_h
#define exemplar_potential_term_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/algebra/vector.h>
#include <exemplar/body/state.h>
#include <exemplar/potential/elastic_body.h>
#include <exemplar/potential/gap.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Where the potential is asked for. It refers to what it was made of.
  struct TermPoint
  {
    const Vector              &positions; ///< by degree of freedom [m]
    const std::vector<double> &weights;   ///< of the examples; empty without examples
  };

  /// What has changed in a term.
  enum class TermChange
  {
    none,
    values,   ///< its energy is another one, on the same couplings
    couplings ///< it couples other nodes, too
  };

  /// What frames show of a term: three numbers a node, by degree of freedom, or one.
  struct NodalField
  {
    std::string  name; ///< in the files
    Vector       values;
    unsigned int n_components = 3;
  };

  /// What a step has done to the energy of a term, of this process, for EnergyAudit.
  struct EnergyFlow
  {
    bool   is_stored = true; ///< whether the body can get the term's energy back, less `lost`
    double lost = 0.; ///< part of the energy at the end of the step: potentials of friction [J]
    double work
        = 0.; ///< of loads, or of what moves or changes the term, by the trapezoidal rule [J]
    double doubt = 0.; ///< half of the difference between the rules of the start and of the end [J]
  };

  /// Why a term has no gradients, as in "There are no gradients {what} yet. {remedy}". Empty: it has.
  struct NoGradients
  {
    std::string what, remedy;
  };

  /// A summand of the incremental potential beside Psi, Eq. (5): inertia, loads, springs. A term that a
  /// scene does not have is not there. Positions, forces and displacements are by degree of freedom.
  ///
  /// Its life: attach(); then for each step begin_step(), renew() at the step's start and where each iteration begins,
  /// energies and tangents between, and end_step() if the step is accepted. Steps that are given up have no end: what
  /// lasts is changed in end_step() alone, and renew() may be called anywhere again.
  ///
  /// Where several processes share a body, a term sums what belongs to the cells and the nodes of its
  /// own process (FreeDofs::exchange() says which), and never over processes: whoever calls it does.
  class PotentialTerm
  {
  public:
    virtual ~PotentialTerm() = default;

    /// What it is, in a word.
    virtual std::string
    name() const = 0;

    /// Pairs of nodes that its tangent couples beside those that share a cell.
    virtual NodePairs
    couplings() const
    {
      return {};
    }

    /// Known from now on: the pattern on which add_tangent() writes, and the free degrees of freedom. Both outlive the
    /// term. Called again when the pattern or what is held has changed.
    virtual void
    attach(const SymmetricPattern & /*pattern*/, const FreeDofs & /*free_dofs*/)
    {
    }

    /// What it is made of has other values from now on: material, masses, loads.
    virtual void
    follow_parameters()
    {
    }

    /// A step of length h [s], which is not used outside of dynamics, begins at `start`, with the cells' damping as
    /// CellField has it; the term belongs to it until end_step() or leave_step().
    virtual void
    begin_step(const State & /*start*/, double /*step_size*/)
    {
    }

    /// An iteration begins here: the term may couple other nodes, as contact does, or renew what it has lagged, as
    /// friction does. Pattern and evaluation then follow before the step goes on, and no step ends with a change. It
    /// must find the same at the same point and step, whatever was evaluated before. Terms with gaps are asked at the step's start and where
    /// the solver is done with what they have lagged: forces of contact are far from the end's until then.
    virtual TermChange
    renew(const TermPoint & /*at*/)
    {
      return TermChange::none;
    }

    /// Whether what it lags had settled where the last step ended: not if it was renewed as often as it may be.
    virtual bool
    has_settled() const
    {
      return true;
    }

    /// Whether its tangent depends on the step that has begun, and not on time, positions and weights alone: a tangent of an
    /// earlier step cannot be made again then, as it must be after a resume.
    virtual bool
    has_tangent_of_step() const
    {
      return false;
    }

    /// What the step with this end has made heat of [J], before end_step(). Empty: the term never makes any.
    virtual std::optional<double>
    dissipation(const State & /*end*/) const
    {
      return {};
    }

    /// The flow of energy in the step with this start and this end, before end_step(). Empty: it is not known.
    virtual std::optional<EnergyFlow>
    energy_flow(const State & /*start*/, const State & /*end*/) const
    {
      return {};
    }

    /// The step has been accepted, with this end.
    virtual void
    end_step(const State & /*end*/)
    {
    }

    /// From now on states are evaluated without a step that leads to them.
    virtual void
    leave_step()
    {
    }

    /// From now on the term is that of time t [s].
    virtual void
    set_time(double /*time*/)
    {
    }

    /// Whether set_time() for these two times [s] makes different terms.
    virtual bool
    differs(double /*time*/, double /*other_time*/) const
    {
      return false;
    }

    /// Add the energy, its derivative by the positions, and the size of the forces at each node.
    virtual void
    add(const TermPoint &at, ElasticSums &sums)
        = 0;

    /// Add its tangent [N/m] of this kind to the values on the pattern and, if there are columns, its
    /// part of the coupling G, Eqs. (9) and (40): one a strained weight on FreeDofs::local_list(). A convex
    /// tangent must not make the sum indefinite.
    virtual void
    add_tangent(const TermPoint & /*at*/,
                Tangent /*kind*/,
                std::vector<double> & /*values*/,
                std::vector<double> & /*columns*/)
    {
    }

    /// Add what `displacement` [m], zero but on held degrees of freedom, changes by that tangent.
    virtual void
    add_response(const TermPoint & /*at*/,
                 Tangent /*kind*/,
                 const Vector & /*displacement*/,
                 ElasticSums & /*sums*/)
    {
    }

    /// The part of `displacement`, of free and held nodes, that a step from these positions may go, at most: beyond it
    /// the energy is not defined, as where an obstacle is passed.
    virtual double
    max_step(const Vector & /*positions*/, const Vector & /*displacement*/) const
    {
      return std::numeric_limits<double>::infinity();
    }

    /// The part of `displacement` that the body may go while obstacles go the same part of the way from where they stand
    /// to where they are at `time` [s] within the step.
    virtual double
    max_step_to(double /*time*/, const Vector &positions, const Vector &displacement) const
    {
      return max_step(positions, displacement);
    }

    /// What of the term, in words, does not allow all of max_step_to().
    virtual std::string
    limit_to(double /*time*/, const Vector & /*positions*/, const Vector & /*displacement*/) const
    {
      return "the term '" + name() + "'";
    }

    /// The greatest width of a gap [m]; 0 for a term that has none. The tangent of a term with gaps stays out of inverses
    /// that are kept for many steps: barriers are too far from quadratic.
    virtual double
    gap_width() const
    {
      return 0.;
    }

    /// Pairs of nodes, ascending and the lesser node first, that the tangent of a term with gaps couples at these positions beside those
    /// that share a cell. The pattern of the tangent has them, and that of inverses that are kept has not.
    virtual NodePairs
    couplings_of_gaps(const Vector & /*positions*/) const
    {
      return {};
    }

    /// Append all gaps of the body at these positions whose distance is below `range` times their width, in an order
    /// that the mesh decides.
    virtual void
    append_gaps(const Vector & /*positions*/, double /*range*/, std::vector<Gap> & /*gaps*/) const
    {
    }

    /// Append all gaps at these positions that are below their width, and at least those that a displacement, which moves no node farther than
    /// `reach` [m], or one that is as long may bring below it; in an order that the mesh decides.
    virtual void
    append_gaps_along(const Vector &positions,
                      const Vector & /*displacement*/,
                      double            reach,
                      std::vector<Gap> &gaps) const
    {
      append_gaps(positions, 1. + reach / gap_width(), gaps);
    }

    /// Append the gaps of free and held nodes that go straight from positions where all are open to others, while obstacles go from where
    /// they are at `now` to where they are at `time` [s]: gaps at the end of these ways, below `range` times their width, negative and with the
    /// normals of the place where they meet for what meets. Called and left with obstacles at `now`.
    virtual void
    append_gaps_of_way(double now,
                       double time,
                       const Vector & /*from*/,
                       const Vector     &to,
                       double            range,
                       std::vector<Gap> &gaps)
    {
      move_to(time);
      append_gaps(to, range, gaps);
      move_to(now);
    }

    /// Obstacles stand from now on where they are at this time [s] within a step; set_time() moves them to its end.
    virtual void
    move_to(double /*time*/)
    {
    }

    /// Whether obstacles, not loads, stand elsewhere at these two times [s].
    virtual bool
    moves_between(double /*time*/, double /*other_time*/) const
    {
      return false;
    }

    /// The piece of each node of this process, if springs of the term constrain rigid motions of pieces so weakly that
    /// linear solvers have to treat these motions apart; else empty.
    virtual std::vector<unsigned int>
    weakly_constrained_pieces() const
    {
      return {};
    }

    /// A residual force [N] at these positions that is nothing but rounding.
    virtual double
    rounding_force(const Vector & /*positions*/) const
    {
      return 0.;
    }

    /// Append what statistics.csv shall show of the term, names and values, where its energy is
    /// `energy` [J]: that energy, or the work of what moves the term from outside.
    virtual void
    append_columns(double /*energy*/,
                   std::vector<std::pair<std::string, double>> & /*columns*/) const
    {
    }

    /// Append what frames shall show of the term at these positions.
    virtual void
    append_fields(const Vector & /*positions*/, std::vector<NodalField> & /*fields*/) const
    {
    }

    /// Gradients by all that a term is not made of need nothing but its exact tangent; a term that has one, and whose
    /// steps are alike when they are begun again, says so by returning nothing.
    virtual NoGradients
    no_gradients() const
    {
      return { "of terms that were added to the potential, such as '" + name() + "'",
               "Make the problem without add_term()." };
    }

    /// What it remembers from step to step beside the state, for checkpoints. load() reads what save()
    /// wrote.
    virtual void
    save(boost::archive::binary_oarchive & /*archive*/) const
    {
    }

    /// Read what save() wrote.
    virtual void
    load(boost::archive::binary_iarchive & /*archive*/)
    {
    }

    /// In bytes.
    virtual std::size_t
    memory_consumption() const = 0;
  };

  using PotentialTerms = std::vector<std::unique_ptr<PotentialTerm>>;
} // namespace Exemplar

#endif
