// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_potential_term_h
#define exemplar_potential_term_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/algebra/vector.h>
#include <exemplar/body/state.h>
#include <exemplar/potential/cell_field.h>
#include <exemplar/potential/evaluation.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include <limits>
#include <memory>
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

  /// Pairs of nodes whose degrees of freedom a matrix couples.
  using NodePairs = std::vector<std::pair<unsigned int, unsigned int>>;

  /// A summand of the incremental potential beside the energies of the cells: the dilatation of
  /// patches, inertia, loads. A term that a scene does not have is not there. Positions, forces and
  /// displacements are by degree of freedom.
  ///
  /// Where several processes share a body, a term sums what belongs to the cells and the nodes of its
  /// own process (FreeDofs::exchange() says which), and never over processes: whoever calls it does.
  ///
  /// Terms whose energy is part of Psi, Eq. (5), among them all that depend on the weights, are those
  /// of the ElasticPotential; all others are those of the IncrementalPotential.
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

    /// Whether all these couplings are those of outer products, which add_tangent_in_parts() can keep
    /// apart. Then a pattern may be without them.
    virtual bool
    couples_by_products() const
    {
      return false;
    }

    /// Whether begin_step() has changed the couplings, as contact does. The pattern then follows
    /// before the step goes on.
    virtual bool
    has_new_couplings() const
    {
      return false;
    }

    /// Known from now on: the pattern on which add_tangent() writes, the free degrees of freedom, and
    /// the cells, with their rotations and dilatations. All outlive the term. Called again when the
    /// pattern or what is held has changed.
    virtual void
    attach(const SymmetricPattern & /*pattern*/,
           const FreeDofs & /*free_dofs*/,
           CellField & /*cells*/)
    {
    }

    /// What it is made of has other values from now on: material, masses, loads.
    virtual void
    follow_parameters()
    {
    }

    /// A step begins at `start`, with the cells' damping as CellField has it; the term belongs to it
    /// until end_step() or leave_step().
    virtual void
    begin_step(const State & /*start*/)
    {
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

    /// Add energies, the derivatives by the positions and, unless they are empty, by the weights, and
    /// the size of the forces at each node, beside what cells do that have been told. The cells have been
    /// evaluated at this point.
    virtual void
    add(const TermPoint &at, ElasticSums &sums)
        = 0;

    /// Add its part of c_i with dPsi/dw = H w - c [J]; H is the weights' quadratic form.
    virtual void
    add_weight_linear_term(const Vector & /*positions*/, std::vector<double> & /*c*/)
    {
    }

    /// The cells have found their dilatations at these positions, CellField::get_dilatation(). Called
    /// before the functions that follow and those above that take positions.
    virtual void
    hear_cells(const Vector & /*positions*/)
    {
    }

    /// Before the cells are evaluated or make their tangent at this point: write the pressures that act
    /// in them, if any, to CellField::get_dilatation(). The three functions below are called after this one, at
    /// the same point.
    virtual void
    tell_cells(const TermPoint & /*at*/)
    {
    }

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

    /// The same on a pattern without its couplings, with these outer products added to `products`, by
    /// node, for terms that couple by them.
    virtual void
    add_tangent_in_parts(const TermPoint & /*at*/,
                         Tangent /*kind*/,
                         std::vector<double> & /*values*/,
                         std::vector<double> & /*columns*/,
                         OuterProducts & /*products*/)
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

    /// Add the elastic energy density that it gives to each quadrature point [J/m^3].
    virtual void
    add_densities(std::vector<double> & /*of_points*/) const
    {
    }

    /// The part of `displacement` that a step from here may go, at most: beyond it the energy is
    /// not defined, as where an obstacle is passed.
    virtual double
    max_step(const Vector & /*positions*/, const Vector & /*displacement*/) const
    {
      return std::numeric_limits<double>::infinity();
    }

    /// A residual force [N] that is nothing but rounding.
    virtual double
    rounding_force() const
    {
      return 0.;
    }

    /// Append what statistics.csv shall show of the term, names and values, where its energy is
    /// `energy` [J].
    virtual void
    append_columns(double /*energy*/,
                   std::vector<std::pair<std::string, double>> & /*columns*/) const
    {
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

  /// Add its tangent, in parts if it has some and there are `products` to add to.
  inline void
  add_tangent_of(PotentialTerm       &term,
                 const TermPoint     &at,
                 const Tangent        kind,
                 std::vector<double> &values,
                 std::vector<double> &columns,
                 OuterProducts       *products)
  {
    if (products == nullptr || !term.couples_by_products())
      term.add_tangent(at, kind, values, columns);
    else
      term.add_tangent_in_parts(at, kind, values, columns, *products);
  }
} // namespace Exemplar

#endif
