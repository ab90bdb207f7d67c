// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/examples.h>
#include <exemplar/python/examples_of_names.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The object of a dotted name, such as "Problem.step", in the module.
    py::object
    member_of(const py::module_ &module, const std::string &name)
    {
      const std::size_t dot   = name.find('.');
      const py::object  outer = module.attr(name.substr(0, dot).c_str());
      if (dot == std::string::npos)
        return outer;
      return outer.attr("__dict__")[name.substr(dot + 1).c_str()];
    }

    /// Appends to the docstring of a function in C, which pybind11 frees by free().
    void
    append_to_function(PyObject *function, const std::string &text)
    {
      if (PyInstanceMethod_Check(function))
        function = PyInstanceMethod_GET_FUNCTION(function);
      if (!PyCFunction_Check(function))
        throw std::logic_error("An example is of what is no function.");
      PyMethodDef *const definition = reinterpret_cast<PyCFunctionObject *>(function)->m_ml;
      const std::string  doc        = definition->ml_doc == nullptr ? "" : definition->ml_doc;
      std::free(const_cast<char *>(definition->ml_doc));
      definition->ml_doc = strdup((doc + text).c_str());
    }

    void
    append(const py::object &member, const std::string &text)
    {
      const bool is_property = PyObject_TypeCheck(member.ptr(), &PyProperty_Type) != 0;
      if (is_property || PyType_Check(member.ptr()))
        member.attr("__doc__") = std::string(py::str(member.attr("__doc__"))) + text;
      else
        append_to_function(member.ptr(), text);
    }
  } // namespace

  void
  add_examples(const py::module_ &module)
  {
    for (const auto &[name, example] : examples_of_names())
      append(member_of(module, name), "\n\n" + std::string(example));
  }
} // namespace Exemplar::Python
