// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_type_h
#define exemplar_problem_type_h

#include <exemplar/exemplar.h>
#include <exemplar/python/held_problem.h>

#include <pybind11/pybind11.h>

// Parts of Python's type exemplar.Problem, and of its states and reports, that pybind11 does not
// provide.

namespace Exemplar::Python
{
  /// Whether pybind11 has given a value to an object of one of its types.
  inline bool
  is_made(const pybind11::handle &object)
  {
    auto *const instance = reinterpret_cast<pybind11::detail::instance *>(object.ptr());
    // the collector may look at an object that pybind11 has not laid out yet
    if (!instance->simple_layout && instance->nonsimple.status == nullptr)
      return false;
    return instance->get_value_and_holder().value_ptr() != nullptr;
  }

  /// A sentence on how to get a value of this type in Python; one for each type that has a
  /// MadeCaster.
  inline const char *
  how_to_get(const SavedState * /*type*/)
  {
    return "A State is got from a problem: problem.state.";
  }

  inline const char *
  how_to_get(const SolveReport * /*type*/)
  {
    return "A Report is what a step returns: problem.step().";
  }

  /// pybind11's caster for a class, which also refuses objects whose __init__ was never called, as
  /// type.__new__(type) and pickles that were changed make them: pybind11 would take memory that
  /// nobody has filled for their values.
  template <typename T>
  struct MadeCaster : pybind11::detail::type_caster_base<T>
  {
    bool
    load(const pybind11::handle source, const bool convert)
    {
      if (pybind11::isinstance<T>(source) && !is_made(source))
        throw pybind11::type_error("This object was never made. "
                                   + std::string(how_to_get(static_cast<const T *>(nullptr))));
      return pybind11::detail::type_caster_base<T>::load(source, convert);
    }
  };

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

  /// Makes the error on an attribute that the type does not have name the nearest one.
  void
  suggest_attributes(const pybind11::object &type);

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
  struct type_caster<Exemplar::Python::SavedState>
      : Exemplar::Python::MadeCaster<Exemplar::Python::SavedState>
  {
  };

  template <>
  struct type_caster<Exemplar::SolveReport> : Exemplar::Python::MadeCaster<Exemplar::SolveReport>
  {
  };

  template <>
  struct type_caster<Exemplar::Python::HeldProblem>
      : Exemplar::Python::MadeCaster<Exemplar::Python::HeldProblem>
  {
  };
} // namespace pybind11::detail

#endif
