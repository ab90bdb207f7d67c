// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_type_h
#define exemplar_problem_type_h

#include <exemplar/python/held_problem.h>
#include <exemplar/python/made_objects.h>

// Parts of Python's type exemplar.Problem that pybind11 does not provide.

namespace Exemplar::Python
{
  /// The problem of a Python object of type exemplar.Problem; null while its __init__ has not made
  /// one.
  HeldProblem *
  held_by(PyObject *object);

  inline const char *
  how_to_get(const HeldProblem * /*type*/)
  {
    return "Call exemplar.Problem(scene), and in a subclass super().__init__(scene).";
  }

  using ProblemClass = pybind11::class_<HeldProblem, std::shared_ptr<HeldProblem>>;

  /// Adds an overload that refuses all calls of a method that fit no other, with `usage`; pybind11
  /// would print all arguments, arrays too.
  void
  refuse_other_arguments(ProblemClass &problem, const char *name, const std::string &usage);

  /// Adds a __setattr__ that sets attributes as Python does, but refuses methods and read-only
  /// properties, and says what to do instead.
  void
  add_refusals_to_set(ProblemClass &problem);

  /// Makes pickle and copy refuse the objects of a type: with pickle's oldest protocols pybind11
  /// would end the process.
  void
  refuse_pickling(const pybind11::object &type, const std::string &remedy);

  /// Lets Python's garbage collector find and break cycles of problems and their functions.
  void
  support_garbage_collection(PyHeapTypeObject *type);
} // namespace Exemplar::Python

namespace pybind11::detail
{
  template <>
  struct type_caster<Exemplar::Python::HeldProblem>
      : Exemplar::Python::MadeCaster<Exemplar::Python::HeldProblem>
  {
  };
} // namespace pybind11::detail

#endif
