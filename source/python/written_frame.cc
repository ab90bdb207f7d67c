// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/module_parts.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/output/frame_output.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/run/problem/finiteness.h>

#include <algorithm>
#include <filesystem>

namespace Exemplar::Python
{
  namespace py = pybind11;
  namespace fs = std::filesystem;

  namespace
  {
    const char *const remedy = " Or give another name.";

    const FrameFormat &
    vtu_format()
    {
      return *std::find_if(frame_formats().begin(), frame_formats().end(),
                           [](const FrameFormat &format) { return format.name == "vtu"; });
    }

    fs::path
    file_of(const py::object &object)
    {
      if (!py::isinstance<py::str>(object) && !py::hasattr(object, "__fspath__"))
        throw py::type_error("write(file): file must be a path, but is " + description(object)
                             + ".");
      const fs::path file
          = text_of(py::module_::import("os").attr("fspath")(object), "write(file): the name");
      if (file.extension() != ".vtu")
        throw UserError("write(file): it is " + file.string()
                        + ", but frames are written for ParaView alone. Give a name that ends in "
                          ".vtu.");
      if (const fs::path directory = fs::absolute(file).parent_path(); !fs::is_directory(directory))
        throw UserError("write(file): there is no directory " + directory.string()
                        + ". Make it first.");
      return file;
    }

    Frame
    finite_frame(Problem &problem)
    {
      Frame frame = frame_of(problem);
      if (const std::string what = what_is_not_finite(frame); !what.empty())
        throw UserError("write(file): the frame would hold " + what
                        + " that are not finite numbers. Take smaller steps, and look at what "
                          "handles and loads do.");
      return frame;
    }

    void
    write_frame(Problem &problem, const fs::path &file)
    {
      const Frame frame = finite_frame(problem);
      try
      {
        vtu_format()
            .writer_of({ problem.body.mesh, problem.body.fe_space, nullptr })
            ->write(frame, file);
      }
      catch (const std::runtime_error &error)
      {
        throw UserError(std::string("write(file): ") + error.what());
      }
    }

    void
    write(HeldProblem &held, const py::object &object)
    {
      const fs::path file = file_of(object);
      held.use("write()",
               [&](Problem &problem)
               {
                 require_replaceable({ file, vtu_format().frame_beginning, "</VTKFile>\n" },
                                     held.get_inputs().files(), remedy);
                 write_frame(problem, file);
               });
    }
  } // namespace

  void
  add_write(ProblemClass &problem)
  {
    problem.def(
        "write", &write, py::arg("file"),
        "write(file)\n\n"
        "Write where the body stands as a frame of a run for ParaView, with displacements,\n"
        "velocities, energy densities, det F and von Mises stresses (doc/output.md).\n\n"
        "file: a path that ends in .vtu. A whole frame that is there is replaced. Raises "
        "UserError,\n"
        "with nothing changed, for another name, for a file that exemplar has not written or that\n"
        "the scene names, and where nothing can be written.");
    refuse_other_arguments(problem, "write", "write is called as write(file), file being a path.");
  }
} // namespace Exemplar::Python
