// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>
#include <exemplar/python/problem_type.h>

#include <map>
#include <vector>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The problem of a Python object of type exemplar.Problem; null while its __init__ has not
    /// made one.
    HeldProblem *
    held_by(PyObject *object)
    {
      if (!is_made(object))
        return nullptr;
      const py::detail::value_and_holder held
          = reinterpret_cast<py::detail::instance *>(object)->get_value_and_holder();
      return held.holder_constructed() ? held.value_ptr<HeldProblem>() : nullptr;
    }

    extern "C"
    {
      int
      traverse_problem(PyObject *self, visitproc visit, void *arg)
      {
        Py_VISIT(Py_TYPE(self));
        HeldProblem *held = held_by(self);
        return held == nullptr ? 0 : held->get_functions().visit(visit, arg);
      }

      int
      clear_problem(PyObject *self)
      {
        if (HeldProblem *held = held_by(self))
          held->get_functions().forget();
        return 0;
      }

      void
      end_problem(PyObject *self)
      {
        PyObject_GC_UnTrack(self); // before its parts are destroyed
        py::detail::pybind11_object_dealloc(self);
      }
    }

    /// The message on an attribute that the type does not have, with the nearest one.
    std::string
    without_attribute(const py::handle &type, const std::string &name)
    {
      std::vector<std::string> names;
      if (!name.empty() && name[0] != '_') // numpy and others look for such names often
        for (const py::handle one : py::module_::import("builtins").attr("dir")(type))
          if (std::string of_type = py::str(one); of_type[0] != '_')
            names.push_back(std::move(of_type));
      const std::string nearest = nearest_word(name, names);
      return "exemplar." + std::string(py::str(type.attr("__name__"))) + " has no attribute '"
             + name + "'." + (nearest.empty() ? "" : " Did you mean '" + nearest + "'?");
    }

    /// __setattr__ as Python's own, but setting a method raises an error that tells to call it.
    void
    set_attribute(const py::object &problem, const py::str &name, const py::object &value)
    {
      if (PyObject_GenericSetAttr(problem.ptr(), name.ptr(), value.ptr()) == 0)
        return;
      py::error_already_set                            error;
      static const std::map<std::string, const char *> remedies
          = { { "positions",
                "Set the whole state: problem.state = problem.state.replace(positions=...)." },
              { "velocities",
                "Set the whole state: problem.state = problem.state.replace(velocities=...)." },
              { "weights", "Set the whole state, problem.state = "
                           "problem.state.replace(weights=...), or hold them in a scene "
                           "with Weights = prescribed." },
              { "time", "Set the whole state: problem.state = problem.state.replace(time=...)." },
              { "handles", "Handles come by problem.hold() and problem.grab(), move by "
                           "set_motion() and go by let_go()." },
              { "rest_positions", "A body of another shape is another problem: "
                                  "exemplar.Problem(scene, mesh=(nodes, cells))." },
              { "cells", "A body of other cells is another problem: exemplar.Problem(scene, "
                         "mesh=(nodes, cells))." } };
      if (const auto remedy = remedies.find(name);
          remedy != remedies.end() && error.matches(PyExc_AttributeError))
        throw py::attribute_error(remedy->first + " cannot be set. " + remedy->second);
      const py::object attribute = py::getattr(py::type::of(problem), name, py::none());
      if (error.matches(PyExc_AttributeError) && PyCallable_Check(attribute.ptr()) != 0)
        throw py::attribute_error(std::string(name) + " is called, not set: problem."
                                  + std::string(name) + "(...).");
      if (error.matches(PyExc_AttributeError) && !py::hasattr(py::type::of(problem), name))
        throw py::attribute_error(without_attribute(py::type::of(problem), name));
      throw error;
    }
  } // namespace

  void
  suggest_attributes(const py::object &type)
  {
    type.attr("__getattr__") = py::cpp_function(
        [](const py::object &self, const std::string &name) -> py::object
        { throw py::attribute_error(without_attribute(py::type::of(self), name)); },
        py::name("__getattr__"), py::is_method(type));
  }

  void
  refuse_pickling(const py::object &type, const std::string &remedy)
  {
    const std::string message = "cannot pickle an exemplar."
                                + std::string(py::str(type.attr("__name__"))) + ". " + remedy;
    type.attr("__reduce__") = py::cpp_function([message](const py::object & /*self*/) -> py::object
                                               { throw py::type_error(message); },
                                               py::name("__reduce__"), py::is_method(type));
  }

  void
  refuse_other_arguments(ProblemClass &problem, const char *name, const std::string &usage)
  {
    problem.def(name, [usage](const HeldProblem &, const py::args &, const py::kwargs &)
                { throw py::type_error(usage); });
  }

  void
  add_refusals_to_set(ProblemClass &problem)
  {
    problem.def("__setattr__", &set_attribute);
  }

  void
  support_garbage_collection(PyHeapTypeObject *type)
  {
    type->ht_type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    type->ht_type.tp_traverse = traverse_problem;
    type->ht_type.tp_clear    = clear_problem;
    type->ht_type.tp_dealloc  = end_problem;
  }
} // namespace Exemplar::Python
