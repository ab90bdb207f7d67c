// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_fibre_tension_term_h
#define exemplar_fibre_tension_term_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/kernels/cell_kernels.h>
#include <exemplar/potential/cell_scatter.h>
#include <exemplar/potential/potential_term.h>
#include <exemplar/prm/expression.h>

#include <deal.II/base/aligned_vector.h>

#include <optional>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// How the tension of a fibre depends on its stretch: a factor f that is linear between the stretches of a table and
  /// constant outside of it. Below a least stretch the energy goes on as a parabola of equal slope, so that it is smooth.
  class TensionCurve
  {
  public:
    static constexpr double least_stretch = 0.1;

    /// f = 1.
    TensionCurve() = default;

    /// Parse "stretch: factor; stretch: factor; ...", at least two, of ascending stretches above 0 and factors of at
    /// least 0; empty: f = 1. Throws UserError, calling the text `key`, for anything else.
    TensionCurve(const std::string &text, const std::string &key);

    /// At a stretch: the integral of f from 1, f, and its derivative.
    struct Value
    {
      double energy, force, slope;
    };

    Value
    at(double stretch) const;

    /// Whether f = 1: then at() is { stretch - 1, 1, 0 } from least_stretch on.
    bool
    is_constant() const
    {
      return table.empty();
    }

  private:
    /// The same without the parabola.
    Value
    of_table(double stretch) const;

    std::vector<std::pair<double, double>> table;     ///< stretches and factors; empty: f = 1
    std::vector<double>                    integrals; ///< of f, from the first stretch to each
  };

  /// Active fibres, Eq. (45): sum V T(t) W(|F a|) with the tension T of a cell at the end of a step, its fibres a at rest and
  /// the integral W of its TensionCurve; |F a| - 1 without one.
  class FibreTensionTerm : public PotentialTerm
  {
  public:
    /// Tensions that are held [Pa], one a cell, replace those of the material; empty: none. All must outlive the term.
    /// Throws UserError for tensions and curves that cannot be parsed.
    FibreTensionTerm(const Material            &material,
                     const FESpace             &fe_space,
                     const std::vector<double> &held);

    std::string
    name() const override
    {
      return "fibre tension";
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    follow_parameters() override;

    /// Throws SolverFailure for a negative tension.
    void
    set_time(double time) override;

    bool
    differs(double time, double other_time) const override;

    std::optional<EnergyFlow>
    energy_flow(const State &start, const State &end) const override;

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    /// Falling parts of curves are left out of a convex tangent.
    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    void
    add_response(const TermPoint &at,
                 Tangent          kind,
                 const Vector    &displacement,
                 ElasticSums     &sums) override;

    void
    append_columns(const double                                 energy,
                   std::vector<std::pair<std::string, double>> &columns) const override
    {
      columns.emplace_back("energy_tension", energy);
    }

    NoGradients
    no_gradients() const override
    {
      return {};
    }

    /// T of each cell [Pa] at the time that is set; 0 where there are no active fibres.
    const std::vector<double> &
    tensions() const
    {
      return tension;
    }

    /// The fibre of a point at positions, and what the energy W of its curve does.
    struct Fibre
    {
      Vector3<double>     rest, now;    ///< a and F a
      double              stretch;      ///< |F a|
      double              force_factor; ///< of F a in dW / d(F a), also where that is 0
      TensionCurve::Value curve;

      /// The derivative of force_factor F a along a change of F a.
      Vector3<double>
      change(const Vector3<double> &of_now, Tangent kind) const;
    };

    /// Of a cell whose tension is the scene's, among tensions that are held.
    static constexpr double not_held = -1.;

    /// None where the cell has no active fibres.
    std::optional<Fibre>
    fibre(unsigned int point, const Vector &positions) const;

    std::size_t
    memory_consumption() const override;

  private:
    /// A tension of the material, ready to be evaluated.
    struct Law
    {
      Expression   formula;
      bool         depends_on_place, depends_on_time;
      TensionCurve curve;
    };

    /// T of each cell with active fibres at a time [s].
    std::vector<double>
    tensions_at(double time) const;

    const TensionCurve &
    curve(const unsigned int cell) const
    {
      return laws[of_material.of_cells[cell] - 1].curve;
    }

    /// Make tensions and amounts those of the time that is set.
    void
    find_tensions();

    /// Replace the vectors F a of points, of active cells from the given one on, by the forces that add_fibre_forces() takes, by their
    /// curves. Returns their energy [J].
    double
    find_forces(std::size_t begin, std::size_t end, double *vectors) const;

    /// Keep the nodes of the cells with fibres, ascending in each, and the shape gradients along these.
    void
    keep_shares();

    /// What depends on F a alone.
    Fibre
    at_vector(unsigned int cell, const Vector3<double> &now) const;

    /// The second derivative of a point's energy by F a [J], of active cells.
    Matrix3<double>
    stiffness(std::size_t point, const Vector &positions, Tangent kind) const;

    const FibreTensions       &of_material;
    const Material            &material;
    const FESpace             &fe_space;
    const std::vector<double> &held;
    std::vector<Law>           laws; ///< in the order of FibreTensions::sources
    std::vector<unsigned int>  active_cells;
    std::vector<unsigned int>  nodes; ///< of the active cells, ascending in each
    std::vector<double>
        shares; ///< shape gradients along the fibre, of the active cells' points and nodes in order
    const CellKernels            &kernels;
    dealii::AlignedVector<double> node_positions, node_sums; ///< of add(), four numbers a node
    std::vector<double>           tension;
    std::vector<double>           amounts; ///< tension times volume of the active cells' points [J]
    bool                          are_constant = true;  ///< whether no law has a curve
    bool                          are_steady   = true;  ///< whether no law depends on time
    bool                          are_known    = false; ///< whether tensions have been found
    std::vector<double>           held_then;            ///< the held ones that they were found with
    double                        time = 0.;
    std::optional<CellScatter>    scatter; ///< since attach()
  };

  /// The term among others; null: there is none.
  const FibreTensionTerm *
  find_tension_term(const PotentialTerms &terms);

  /// Sentences on what the tensions at these times [s] mean: fibres that shorten by most of their length. All processes must
  /// call this. Throws as set_time().
  std::vector<std::string>
  describe_tensions(FibreTensionTerm          &term,
                    const Material            &material,
                    const FESpace             &fe_space,
                    const std::vector<double> &times);
} // namespace Exemplar

#endif
