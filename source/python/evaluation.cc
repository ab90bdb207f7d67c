// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/arrays_to_python.h>
#include <exemplar/python/evaluation.h>
#include <exemplar/python/from_python.h>

#include <fmt/core.h>

#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    std::vector<double>
    weights_of(const py::object &object, const std::string &what, const std::size_t n)
    {
      std::vector<double> numbers
          = n == 0 ? std::vector<double>() : numbers_of(object, what + ": weights", py::ssize_t(n));
      if (numbers.size() != n
          || py::array::ensure(object).size() != static_cast<py::ssize_t>(n)) // one number for all
        throw UserError(fmt::format(
            "{}: weights must be an array of shape ({},), as problem.weights, but is {}.", what, n,
            description(object)));
      return numbers;
    }

    /// The place to evaluate at; None stands for the value of the state.
    Place
    place_of(const HeldProblem &held,
             const py::object  &positions,
             const py::object  &weights,
             const std::string &what)
    {
      const Problem &problem = held.get();
      Place          at{ problem.state.positions, problem.state.weights };
      if (!positions.is_none())
      {
        const auto rows = points_of(positions, what + ": positions",
                                    py::ssize_t(problem.body.fe_space.n_nodes()));
        for (unsigned int dof = 0; dof < at.positions.size(); ++dof)
          at.positions[dof] = rows[dof / 3][dof % 3];
      }
      if (!weights.is_none())
        at.weights = weights_of(weights, what, at.weights.size());
      return at;
    }

    Tangent
    kind_of(const py::object &object, const std::string &what)
    {
      const std::string kind
          = py::isinstance<py::str>(object) ? text_of(object, what + ": kind") : "";
      if (kind != "exact" && kind != "convex")
        throw UserError(what + ": kind is " + std::string(py::repr(object))
                        + ", but must be 'exact' or 'convex'.");
      return kind == "exact" ? Tangent::exact : Tangent::convex;
    }

    double
    energy(HeldProblem &held, const py::object &positions, const py::object &weights)
    {
      const Place at  = place_of(held, positions, weights, "energy");
      double      phi = 0.;
      ask(held, "energy()", [&](Laboratory &lab) { phi = lab.evaluate(at).potential; });
      return phi;
    }

    py::array
    gradient(HeldProblem &held, const py::object &positions, const py::object &weights)
    {
      const Place         at = place_of(held, positions, weights, "gradient");
      std::vector<double> numbers;
      ask(held, "gradient()",
          [&](Laboratory &lab)
          {
            const Vector &field = lab.evaluate(at).gradient;
            numbers.assign(field.begin(), field.end());
          });
      const auto n = static_cast<py::ssize_t>(numbers.size() / 3);
      return array_of(std::move(numbers), { n, 3 });
    }

    py::array
    weight_gradient(HeldProblem &held, const py::object &positions, const py::object &weights)
    {
      const Place         at = place_of(held, positions, weights, "weight_gradient");
      std::vector<double> numbers;
      ask(held, "weight_gradient()", [&](Laboratory &lab) { numbers = lab.weight_gradient(at); });
      const auto k = static_cast<py::ssize_t>(numbers.size());
      return array_of(std::move(numbers), { k });
    }

    py::object
    hessian(HeldProblem      &held,
            const py::object &positions,
            const py::object &weights,
            const py::object &kind)
    {
      scipy("scipy.sparse"); // before the work
      const Place   at      = place_of(held, positions, weights, "hessian");
      const Tangent tangent = kind_of(kind, "hessian");
      RowMatrix     matrix;
      ask(held, "hessian()", [&](Laboratory &lab) { matrix = lab.hessian(at, tangent); });
      return sparse_array(std::move(matrix));
    }

    py::array
    coupling(HeldProblem      &held,
             const py::object &positions,
             const py::object &weights,
             const py::object &kind)
    {
      const Place         at      = place_of(held, positions, weights, "coupling");
      const Tangent       tangent = kind_of(kind, "coupling");
      std::vector<double> columns;
      ask(held, "coupling()", [&](Laboratory &lab) { columns = lab.coupling(at, tangent); });
      const auto k = static_cast<py::ssize_t>(at.weights.size());
      const auto n = static_cast<py::ssize_t>(at.positions.size());
      return py::array(array_of(std::move(columns), { k, n }).attr("T"));
    }

    py::array
    weight_hessian(HeldProblem &held)
    {
      dealii::FullMatrix<double> H;
      ask(held, "weight_hessian()", [&](Laboratory &lab) { H = lab.weight_hessian(); });
      return array_of(H);
    }

    /// The reduced Hessian A - G P G^T.
    py::object
    reduced_hessian(HeldProblem      &held,
                    const py::object &positions,
                    const py::object &weights,
                    const py::object &kind)
    {
      const py::object A  = hessian(held, positions, weights, kind);
      const Place      at = place_of(held, positions, weights, "reduced_hessian");
      py::cpp_function times([A](const py::object &x) { return A.attr("__matmul__")(x); });
      if (held.get().examples.weights.n_unknown() > 0)
      {
        const py::object           G = coupling(held, positions, weights, kind);
        dealii::FullMatrix<double> compliance;
        ask(held, "reduced_hessian()",
            [&](Laboratory &lab) { compliance = lab.weight_compliance(at); });
        const py::object P = array_of(compliance);
        times              = py::cpp_function(
            [A, G, P](const py::object &x)
            {
              const py::object of_weights = P.attr("__matmul__")(G.attr("T").attr("__matmul__")(x));
              return A.attr("__matmul__")(x).attr("__sub__")(G.attr("__matmul__")(of_weights));
            });
      }
      return scipy("scipy.sparse.linalg")
          .attr("LinearOperator")(A.attr("shape"), py::arg("matvec") = times,
                                  py::arg("rmatvec") = times, py::arg("matmat") = times,
                                  py::arg("rmatmat") = times,
                                  py::arg("dtype")   = py::dtype::of<double>());
    }

    py::object
    mass(HeldProblem &held)
    {
      scipy("scipy.sparse");
      RowMatrix matrix;
      held.use("mass", [&](Problem &problem) { matrix = mass_matrix(problem); });
      return sparse_array(std::move(matrix));
    }

    void
    add_potential(ProblemClass &problem)
    {
      const auto none = py::none();
      problem.def(
          "energy", &energy, py::arg("positions") = none, py::arg("weights") = none,
          "energy(positions=None, weights=None) -> float\n\n"
          "The incremental potential Phi [J] of doc/dynamics.md, which the next step of a dynamic\n"
          "scene minimises: with inertia, damping and the loads at that step's end. Otherwise "
          "energy\n"
          "and loads at the present time.\n"
          "positions: (n, 3) [m], with Element = P2 the middles of edges, too, as in final.msh "
          "with\n"
          "Final pose = quadratic. weights: (k,), as problem.weights. None: those of the state. "
          "No\n"
          "weights are minimised again, and nothing of the problem changes. Raises UserError for\n"
          "other shapes, and RuntimeError within a step. Other Python threads run meanwhile.");
      problem.def("gradient", &gradient, py::arg("positions") = none, py::arg("weights") = none,
                  "gradient(positions=None, weights=None) -> (n, 3)\n\n"
                  "d Phi/dx [N] by all nodes, held ones included: there what the handles must "
                  "hold.\n"
                  "Arguments and errors as of energy(). With Gradient = frozen it is the paper's "
                  "force,\n"
                  "which is no gradient.");
      problem.def("weight_gradient", &weight_gradient, py::arg("positions") = none,
                  py::arg("weights") = none,
                  "weight_gradient(positions=None, weights=None) -> (k,)\n\n"
                  "d Phi/dw [J], kinks of Examples/Yield aside. Arguments and errors as of "
                  "energy();\n"
                  "UserError, too, where no weight is unknown.");
      problem.def(
          "hessian", &hessian, py::arg("positions") = none, py::arg("weights") = none,
          py::arg("kind") = "exact",
          "hessian(positions=None, weights=None, kind='exact') -> scipy.sparse.csr_array (3n, "
          "3n)\n\n"
          "d2 Phi/dx2 [N/m] by all degrees of freedom 3 i + c, held ones included; kind='convex' "
          "is\n"
          "what the solver takes where that is indefinite. Outer products of patches are in it.\n"
          "Arguments and errors as of energy(); ImportError without scipy.");
      problem.def(
          "coupling", &coupling, py::arg("positions") = none, py::arg("weights") = none,
          py::arg("kind") = "exact",
          "coupling(positions=None, weights=None, kind='exact') -> (3n, k)\n\n"
          "G = -d2 Phi/dx dw [N] of doc/model.md, Eq. (40); kind='convex': Eq. (9). Zero for "
          "the\n"
          "rest pose. Arguments and errors as of weight_gradient().");
      problem.def("weight_hessian", &weight_hessian,
                  "weight_hessian() -> (k, k)\n\n"
                  "H = d2 Phi/dw2 [J] of doc/model.md, Eq. (9), which is the same everywhere. "
                  "Raises\n"
                  "UserError where no weight is unknown.");
      problem.def(
          "reduced_hessian", &reduced_hessian, py::arg("positions") = none,
          py::arg("weights") = none, py::arg("kind") = "exact",
          "reduced_hessian(positions=None, weights=None, kind='exact')\n"
          "    -> scipy.sparse.linalg.LinearOperator (3n, 3n)\n\n"
          "x -> A x - G P G^T x, the matrix reduced by the weights, which is dense: weights above\n"
          "their bounds follow the positions (by P x G^T), their sums held; others stay. Where no\n"
          "weight is unknown it is hessian(). Arguments and errors as of hessian().");
      problem.def_property_readonly("mass", &mass,
                                    "Mass matrix [kg], scipy.sparse.csr_array (3n, 3n); in static "
                                    "scenes, too. A copy.");
    }

  } // namespace

  void
  add_evaluation(ProblemClass &problem)
  {
    add_potential(problem);
    for (const char *name : { "energy", "gradient", "weight_gradient" })
      refuse_other_arguments(
          problem, name, fmt::format("{0} is called as {0}(positions=None, weights=None).", name));
    for (const char *name : { "hessian", "coupling", "reduced_hessian" })
      refuse_other_arguments(
          problem, name,
          fmt::format("{0} is called as {0}(positions=None, weights=None, kind='exact').", name));
    refuse_other_arguments(problem, "weight_hessian", "weight_hessian() takes no argument.");
  }
} // namespace Exemplar::Python
