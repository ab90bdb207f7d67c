// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/module_parts.h>

#include <cstdlib>
#include <cstring>
#include <string>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// Finds the arguments of the call that a docstring begins with; false if there is none.
    bool
    find_arguments(const std::string &doc, const std::string &name, std::string &arguments)
    {
      std::string call = doc.substr(0, doc.find("\n\n"));
      call             = call.substr(0, call.find("->"));
      call.erase(call.find_last_not_of(" \n") + 1);
      if (call.compare(0, name.size() + 1, name + "(") != 0 || call.back() != ')')
        return false;
      arguments = call.substr(name.size() + 1, call.size() - name.size() - 2);
      return true;
    }

    /// Adds a signature to the docstring of a function in C. Python makes __text_signature__ of the
    /// text before "--", and hides it in __doc__. pybind11 frees docstrings by free().
    void
    add_signature(PyObject *function, const std::string &self, const std::string &type)
    {
      if (PyInstanceMethod_Check(function))
        function = PyInstanceMethod_GET_FUNCTION(function);
      if (!PyCFunction_Check(function))
        return;
      PyMethodDef *const definition = reinterpret_cast<PyCFunctionObject *>(function)->m_ml;
      const std::string  name       = definition->ml_name;
      const std::string  doc        = definition->ml_doc == nullptr ? "" : definition->ml_doc;
      std::string        arguments;
      if (!find_arguments(doc, name == "__init__" ? type : name, arguments))
        return;
      const bool        is_first = self.empty() || arguments.compare(0, self.size(), self) == 0;
      const std::string before   = is_first ? "" : arguments.empty() ? self : self + ", ";
      std::free(const_cast<char *>(definition->ml_doc));
      definition->ml_doc = strdup((name + "(" + before + arguments + ")\n--\n\n" + doc).c_str());
    }
  } // namespace

  void
  add_signatures(const py::module_ &module)
  {
    for (const auto &[name, member] : py::dict(module.attr("__dict__")))
    {
      add_signature(member.ptr(), "", "");
      if (py::isinstance<py::type>(member))
        for (const auto &[inner, method] : py::dict(member.attr("__dict__")))
          add_signature(method.ptr(), "self", py::str(name));
    }
  }
} // namespace Exemplar::Python
