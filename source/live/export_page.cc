// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>
#include <exemplar/live/export_page.h>
#include <exemplar/live/page_files.h>
#include <exemplar/live/run_frames.h>
#include <exemplar/live/surface_frames.h>

#include <deal.II/base/utilities.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    using Json = nlohmann::json;

    const std::string mark_of_page = "<!DOCTYPE html>\n<!-- written by exemplar export -->\n";

    void
    require_replaceable(const fs::path &file)
    {
      std::ifstream in(file, std::ios::binary);
      std::string   begin(mark_of_page.size(), '\0');
      if (fs::exists(file)
          && (!in.read(begin.data(), std::streamsize(begin.size())) || begin != mark_of_page))
        throw UserError(file.string()
                        + " is there, and is no page that exemplar export has written. Nothing has "
                          "been changed. Give another name by --html.");
      const fs::path parent = fs::absolute(file).parent_path();
      if (!fs::is_directory(parent))
        throw UserError(parent.string()
                        + " is no directory. Make it, or give another name by --html.");
    }

    std::string
    in_base64(const std::string &bytes)
    {
      return dealii::Utilities::encode_base64({ bytes.begin(), bytes.end() });
    }

    /// Columns of statistics.csv that are worth a plot, with the times.
    Json
    plots_of(const fs::path &directory)
    {
      std::ifstream            table(directory / "statistics.csv");
      std::vector<std::string> names;
      std::string              line, cell;
      std::getline(table, line);
      for (std::istringstream cells(line); std::getline(cells, cell, ',');)
        names.push_back(cell);
      Json columns = Json::object();
      while (std::getline(table, line))
      {
        std::istringstream cells(line);
        for (const std::string &name : names)
          if (std::getline(cells, cell, ',')
              && (name == "time" || name.compare(0, 7, "weight_") == 0
                  || name.compare(0, 7, "energy_") == 0))
            columns[name].push_back(std::strtod(cell.c_str(), nullptr));
      }
      return columns;
    }

    /// The vertices of triangles, and the triangles by them.
    BodySurface
    surface_in(const fs::path &file)
    {
      BodySurface               surface;
      const auto                faces = boundary_in(file);
      std::vector<unsigned int> all;
      for (const auto &face : faces)
        all.insert(all.end(), face.begin(), face.end());
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
      surface.nodes = all;
      for (auto face : faces)
      {
        for (unsigned int &node : face)
          node = std::lower_bound(all.begin(), all.end(), node) - all.begin();
        surface.triangles.push_back(face);
      }
      return surface;
    }

    /// Puts texts into the places of a page.
    void
    replace(std::string &page, const std::string &place, const std::string &text)
    {
      const auto where = page.find(place);
      if (where == std::string::npos)
        throw std::runtime_error("The page lacks " + place);
      page.replace(where, place.size(), text);
    }

    /// JSON that may stand in a script.
    std::string
    in_script(const Json &data)
    {
      std::string text = data.dump(-1, ' ', true, Json::error_handler_t::replace);
      for (std::size_t i = 0; (i = text.find("</", i)) != std::string::npos; i += 3)
        text.replace(i, 2, "<\\/"); // must not end the script
      return text;
    }

    /// A run, as the page has it.
    struct PageRun
    {
      Json        data;
      std::string topology, frames;
      std::size_t n_frames = 0;
      double      error    = 0.; ///< of a coordinate [m]
    };

    PageRun
    run_in(const fs::path &directory)
    {
      const std::vector<RunFrame> frames  = frames_of_run(directory);
      const BodySurface           surface = surface_in(frames.front().file);
      PageRun                     run;
      for (std::uint32_t i = 0; i < frames.size(); ++i)
      {
        const std::vector<double> places = places_in(frames[i].file);
        if (3 * surface.nodes.back() + 2 >= places.size())
          throw UserError(frames[i].file.string() + " has other nodes than the first frame.");
        const Vector positions(places.begin(), places.end());
        run.frames
            += *frame_message({ BinaryKind::frame, i, i, 0, frames[i].time }, surface, positions);
        run.error = std::max(run.error, rounding_of_frame(surface, positions));
      }
      run.topology = *topology_message(surface);
      run.n_frames = frames.size();
      run.data     = { { "name", fs::absolute(directory / "").parent_path().filename().string() },
                       { "frames", frames.size() },
                       { "error", run.error },
                       { "plots", plots_of(directory) } };
      return run;
    }

    /// Bytes that are no script, under a name by which the page finds them.
    std::string
    element(const std::string &name, const std::size_t i, const std::string &bytes)
    {
      return fmt::format("<script type=\"text/plain\" id=\"{}-{}\">{}</script>\n", name, i,
                         in_base64(bytes));
    }

    void
    write(const std::string &page, const fs::path &file)
    {
      const fs::path temporary = file.string() + ".tmp";
      std::ofstream  out(temporary, std::ios::binary);
      out << page << std::flush;
      if (!out)
      {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw std::runtime_error(file.string() + " cannot be written: is the disk full?");
      }
      fs::rename(temporary, file);
    }
  } // namespace

  RunPage
  page_of_runs(const std::vector<std::string> &directories)
  {
    RunPage     result;
    Json        runs = Json::array();
    std::string elements;
    for (const std::string &directory : directories)
    {
      const PageRun run = run_in(directory);
      elements += element("topology", runs.size(), run.topology);
      elements += element("frames", runs.size(), run.frames);
      runs.push_back(run.data);
      result.n_frames += run.n_frames;
      result.error = std::max(result.error, run.error);
    }
    std::string page = page_file("export.html");
    replace(page, "@THREE@", three_file("three.min.js"));
    replace(page, "@CONTROLS@", three_file("examples/js/controls/OrbitControls.js"));
    replace(page, "@PLAYER@", page_file("player.js"));
    replace(page, "@STYLE@", page_file("style.css"));
    replace(page, "@DATA@", in_script({ { "runs", runs } }));
    replace(page, "@RUNS@", elements);
    result.html = mark_of_page + page;
    return result;
  }

  RunPage
  export_page(const std::vector<std::string> &directories, const fs::path &file)
  {
    require_replaceable(file);
    RunPage page = page_of_runs(directories);
    write(page.html, file);
    return page;
  }
} // namespace Exemplar::Live
