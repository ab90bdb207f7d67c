// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_type_h
#define exemplar_problem_type_h

#include <exemplar/python/held_problem.h>

// What pybind11 leaves open of Python's type exemplar.Problem.

namespace Exemplar::Python
{
  /// The problem of a Python object of type exemplar.Problem; null while its __init__ has not made
  /// one.
  HeldProblem *
  held_by(PyObject *object);

  using ProblemClass = pybind11::class_<HeldProblem, std::shared_ptr<HeldProblem>>;

  /// For calls of a method that fit nothing else; pybind11 would print all that it was given, arrays
  /// too.
  void
  refuse_other_arguments(ProblemClass &problem, const char *name, const std::string &usage);

  /// Let Python's garbage collector find, and end, cycles of problems and their functions.
  void
  support_garbage_collection(PyHeapTypeObject *type);
} // namespace Exemplar::Python

namespace pybind11::detail
{
  /// As of any class, but an object whose __init__ has not been called is refused: pybind11 would
  /// take memory that nobody has filled for its problem.
  template <>
  struct type_caster<Exemplar::Python::HeldProblem>
      : type_caster_base<Exemplar::Python::HeldProblem>
  {
    bool
    load(const handle source, const bool convert)
    {
      if (isinstance<Exemplar::Python::HeldProblem>(source)
          && Exemplar::Python::held_by(source.ptr()) == nullptr)
        throw type_error("This problem was never made: call exemplar.Problem(scene), and in a "
                         "subclass super().__init__(scene).");
      return type_caster_base<Exemplar::Python::HeldProblem>::load(source, convert);
    }
  };
} // namespace pybind11::detail

#endif
