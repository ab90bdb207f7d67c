// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/function_answer.h>
#include <exemplar/python/function_term.h>

#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>
#include <fmt/core.h>

#include <cmath>
#include <set>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    class FunctionTerm : public PotentialTerm
    {
    public:
      FunctionTerm(const py::object &function, std::string name, const State &state)
          : function(function), term_name(std::move(name)), time(state.time)
      {
        accept(state);
        learn_couplings(accepted);
      }

      std::string
      name() const override
      {
        return term_name;
      }

      NodePairs
      couplings() const override
      {
        return { pairs.begin(), pairs.end() };
      }

      void
      attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs) override
      {
        pattern   = &new_pattern;
        free_dofs = &new_free_dofs;
      }

      void
      begin_step(const State &start, double /*step_size*/) override
      {
        accept(start);
      }

      TermChange
      renew(const TermPoint &at) override
      {
        return learn_couplings(ask(at.positions, time)) ? TermChange::couplings : TermChange::none;
      }

      void
      end_step(const State &end) override
      {
        if (last.is_for(end.positions, end.time))
          accepted = last;
      }

      void
      set_time(const double new_time) override
      {
        time = new_time;
      }

      bool
      differs(const double one_time, const double other_time) const override
      {
        return one_time != other_time;
      }

      void
      add(const TermPoint &at, ElasticSums &sums) override
      {
        const FunctionAnswer &answer = ask(at.positions, time);
        sums->energy += answer.energy;
        sums->gradient += answer.gradient;
        for (unsigned int node = 0; node < sums->force_scale.size(); ++node)
          sums->force_scale[node]
              += std::hypot(answer.gradient[3 * node], answer.gradient[3 * node + 1],
                            answer.gradient[3 * node + 2]);
      }

      void
      add_tangent(const TermPoint &at,
                  Tangent /*kind*/,
                  std::vector<double> &values,
                  std::vector<double> & /*columns*/) override
      {
        for (const MatrixEntry &entry : ask(at.positions, time).hessian)
        {
          const int i = free_dofs->free_index(entry.row), j = free_dofs->free_index(entry.column);
          if (i == FreeDofs::held || j == FreeDofs::held)
            continue;
          const int position = pattern->position(i, j);
          if (position == pattern->column_start[j + 1] || pattern->row[position] != i)
            refuse_new_coupling(entry);
          values[position] += entry.value;
        }
      }

      void
      add_response(const TermPoint &at,
                   Tangent /*kind*/,
                   const Vector &displacement,
                   ElasticSums  &sums) override
      {
        for (const MatrixEntry &entry : ask(at.positions, time).hessian)
        {
          sums->gradient[entry.row] += entry.value * displacement[entry.column];
          if (entry.row != entry.column)
            sums->gradient[entry.column] += entry.value * displacement[entry.row];
        }
      }

      void
      append_columns(const double                                 energy,
                     std::vector<std::pair<std::string, double>> &columns) const override
      {
        columns.emplace_back("energy_" + term_name, energy);
      }

      void
      save(boost::archive::binary_oarchive &archive) const override
      {
        const NodePairs known = couplings();
        archive        &known;
      }

      void
      load(boost::archive::binary_iarchive &archive) override
      {
        NodePairs known;
        archive  &known;
        pairs = { known.begin(), known.end() };
      }

      std::size_t
      memory_consumption() const override
      {
        return 2
               * (last.positions.memory_consumption() + last.gradient.memory_consumption()
                  + last.hessian.capacity() * sizeof(MatrixEntry));
      }

      TermAnswers
      answers() const
      {
        return { accepted, last.positions.size() > 0 ? last : accepted };
      }

    private:
      void
      accept(const State &state)
      {
        if (!accepted.is_for(state.positions, state.time))
          accepted = ask(state.positions, state.time);
      }

      /// The couplings of an answer join those that are known. Returns whether there are new ones.
      bool
      learn_couplings(const FunctionAnswer &answer)
      {
        const std::size_t n_before = pairs.size();
        for (const MatrixEntry &entry : answer.hessian)
          if (entry.row / 3 != entry.column / 3)
            pairs.emplace(entry.column / 3, entry.row / 3);
        return pairs.size() > n_before;
      }

      /// The answer at a place. Two are kept: that of the state, so that a step in which the
      /// function fails can be taken back without it, and that of the last place.
      const FunctionAnswer &
      ask(const Vector &positions, const double at_time)
      {
        if (accepted.is_for(positions, at_time))
          return accepted;
        if (!last.is_for(positions, at_time))
          last = answer_of(function, term_name, positions, at_time);
        return last;
      }

      [[noreturn]] void
      refuse_new_coupling(const MatrixEntry &entry) const
      {
        throw UserError(fmt::format("{}: the Hessian couples the nodes {} and {}, which it did not "
                                    "where the iteration began. Return zeros for "
                                    "all that it may couple: entries with the value 0 count.",
                                    term_name, entry.row / 3, entry.column / 3));
      }

      const py::object                               &function;
      const std::string                               term_name;
      const SymmetricPattern                         *pattern   = nullptr; ///< since attach()
      const FreeDofs                                 *free_dofs = nullptr; ///< since attach()
      double                                          time;
      FunctionAnswer                                  accepted, last;
      std::set<std::pair<unsigned int, unsigned int>> pairs; ///< pairs of coupled nodes
    };
  } // namespace

  std::unique_ptr<PotentialTerm>
  make_function_term(const py::object &function, std::string name, const State &state)
  {
    return std::make_unique<FunctionTerm>(function, std::move(name), state);
  }

  TermAnswers
  answers_of(const PotentialTerm &term)
  {
    return dynamic_cast<const FunctionTerm &>(term).answers();
  }
} // namespace Exemplar::Python
