// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/function_term.h>
#include <exemplar/python/module_parts.h>
#include <exemplar/python/term_check.h>

#include <fmt/core.h>

#include <cmath>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The name of a term in energies and messages, numbered from 1.
    std::string
    name_of_term(const std::size_t number)
    {
      return fmt::format("term_{}", number);
    }

    void
    require_function(const py::object &function, const std::string &call)
    {
      if (PyCallable_Check(function.ptr()) == 0)
        throw py::type_error(call + ": function is called as function(positions, time), but is "
                             + description(function) + ".");
    }
  } // namespace

  void
  HeldProblem::add_term(const py::object &function)
  {
    require_function(function, "add_term(function)");
    require_no_step("add_term()");
    std::list<KeptTerm> &terms = functions.terms;
    terms.push_back({ function });
    const py::object &kept = terms.back().function;
    const std::string name = name_of_term(terms.size());
    try
    {
      change("add_term()",
             [&kept, &name](Problem &changed)
             {
               changed.add_term([&kept, name, &changed]
                                { return make_function_term(kept, name, changed.state); });
             });
    }
    catch (...)
    {
      if (get().actions.own_terms.size() < terms.size())
        terms.pop_back();
      throw;
    }
  }

  void
  HeldProblem::check_new_terms()
  {
    std::size_t i = 0;
    for (KeptTerm &term : functions.terms)
    {
      const FunctionAnswer &at = answers_of(*problem->actions.own_terms[i++].term).of_state;
      if (term.is_checked || at.gradient.linfty_norm() == 0.)
        continue; // a term that does not act tells nothing
      const std::string complaint = complaint_of_gradient({ term.function, name_of_term(i) }, at);
      if (!complaint.empty())
        throw UserError(complaint);
      term.is_checked = true;
    }
  }

  void
  HeldProblem::blame_terms(const std::string &failure) const
  {
    std::size_t i = 0;
    for (const KeptTerm &term : functions.terms)
    {
      const FunctionAnswer &at   = answers_of(*problem->actions.own_terms[i++].term).last;
      const std::string     name = name_of_term(i);
      std::string           of_gradient;
      try
      {
        of_gradient = complaint_of_gradient({ term.function, name }, at);
      }
      catch (
          const std::exception &) // the failure is to be told, not that of the search for its cause
      {
      }
      if (!of_gradient.empty())
        throw UserError(of_gradient);
      if (const std::string complaint = complaint_of_curvature(name, at); !complaint.empty())
        throw SolverFailure(complaint + " The step failed so: " + failure);
    }
  }

  namespace
  {
    /// The term of a function, or an added term by its number.
    NamedTerm
    term_of(HeldProblem &held, const py::object &object)
    {
      const std::list<KeptTerm> &terms = held.get_functions().terms;
      std::size_t                i     = 0;
      const bool is_number = PyIndex_Check(object.ptr()) != 0 && !py::isinstance<py::bool_>(object);
      for (const KeptTerm &term : terms)
        if (++i; is_number ? object.equal(py::int_(i)) : term.function.is(object))
          return { term.function, name_of_term(i) };
      if (is_number)
        throw UserError(fmt::format("check_term({}): terms are counted from 1, as in "
                                    "energies['energy_term_1'], and {} {} added.",
                                    std::string(py::repr(object)), terms.size(),
                                    terms.size() == 1 ? "was" : "were"));
      require_function(object, "check_term(function)");
      return { object,
               "the term " + std::string(py::str(py::getattr(object, "__name__", object))) };
    }

    Vector
    positions_of(const py::object &object, const Problem &problem)
    {
      if (object.is_none())
        return problem.state.positions;
      const auto rows = points_of(object, "check_term: positions",
                                  py::ssize_t(problem.body.fe_space.n_nodes()));
      Vector     positions(3 * rows.size());
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        positions[dof] = rows[dof / 3][dof % 3];
      return positions;
    }

    double
    time_of(const py::object &object, const Problem &problem)
    {
      const double time
          = object.is_none() ? problem.state.time : real_number_of(object, "check_term: time");
      if (!std::isfinite(time))
        throw UserError("check_term: time must be finite.");
      return time;
    }

    py::dict
    check_term(HeldProblem      &held,
               const py::object &object,
               const py::object &positions,
               const py::object &time)
    {
      const Problem  &problem = held.get();
      const NamedTerm term    = term_of(held, object);
      const TermCheck found
          = check(term, answer_of(term.function, term.name, positions_of(positions, problem),
                                  time_of(time, problem)));
      py::dict result;
      result["gradient"]  = found.gradient;
      result["hessian"]   = found.hessian;
      result["curvature"] = found.curvature;
      return result;
    }
  } // namespace

  void
  add_terms(ProblemClass &problem)
  {
    problem.def(
        "add_term", &HeldProblem::add_term, py::arg("function"),
        "add_term(function)\n\n"
        "From now on let Phi have a term of one's own: springs, an obstacle, a control.\n\n"
        "function(positions, time) gets positions (n, 3) [m] of all nodes, with Element = P2 the\n"
        "middles of edges, too, and the time t [s], and returns energy [J], gradient (n, 3) [N] "
        "and\n"
        "Hessian [N/m]: a sparse array of scipy (3n, 3n), symmetric and without negative\n"
        "eigenvalues, as it is a part of the exact and the convex tangent; None: zero. Which "
        "nodes\n"
        "it couples, by entries of 0, too, may change from iteration to iteration.\n"
        "It is called in each evaluation, which is slow, and must return the same for the same\n"
        "arguments. Its energy is energies['energy_term_1'] and so on. Raises UserError for what\n"
        "is none of these, and what the function raises; an interpolation has no terms. The first\n"
        "step in which it acts raises UserError where its gradient is not that of its energy.");
    problem.def(
        "check_term", &check_term, py::arg("term"), py::arg("positions") = py::none(),
        py::arg("time") = py::none(),
        "check_term(term, positions=None, time=None) -> dict[str, float]\n\n"
        "Compare by central differences what the function of a term returns.\n\n"
        "term: a function as add_term() takes it, also one that was not added, or the number of\n"
        "one that was, from 1. positions (n, 3) [m] of all nodes, time [s]; None: those of the\n"
        "state. Returns the differences 'gradient' (from the slope of the energy) and 'hessian'\n"
        "(from the slope of the gradient), relative, the greatest along some directions, and\n"
        "'curvature', the least one of the Hessian that was found [N/m]. A Hessian may leave out\n"
        "what is not convex, and then differs. Raises UserError, which names the term, for a\n"
        "gradient that is not that of the energy, a Hessian that is softer than the gradient says\n"
        "or has a negative curvature, and for what add_term() refuses; and what the function\n"
        "raises. Where the gradient has a kink, look beside it.");
    refuse_other_arguments(problem, "add_term",
                           "add_term is called as add_term(function), where function(positions, "
                           "time) returns energy, gradient, hessian.");
    refuse_other_arguments(problem, "check_term",
                           "check_term is called as check_term(term, positions=None, time=None), "
                           "where term is a function or the number of one that was added.");
  }
} // namespace Exemplar::Python
