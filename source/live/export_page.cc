// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/words.h>
#include <exemplar/exemplar.h>
#include <exemplar/live/export_page.h>
#include <exemplar/live/page_files.h>
#include <exemplar/live/run_frames.h>
#include <exemplar/live/surface_frames.h>
#include <exemplar/run/output/output_directory.h>

#include <deal.II/base/utilities.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    using Json = nlohmann::json;

    const std::string mark_of_page = "<!DOCTYPE html>\n<!-- written by exemplar export -->\n";

    void
    require_page(const fs::path &file)
    {
      const std::string remedy = " Give another name by --html.", end = file.extension().string();
      if (end != ".html" && end != ".htm")
        throw UserError("--html: a page is written, found " + in_quotes(file.string())
                        + ". Give a name that ends in .html.");
      const fs::path parent = fs::absolute(file).parent_path();
      if (!fs::is_directory(parent))
        throw UserError(parent.string()
                        + " is no directory. Make it, or give another name by --html.");
      require_replaceable({ file, mark_of_page }, {}, remedy);
    }

    std::string
    in_base64(const std::string &bytes)
    {
      return dealii::Utilities::encode_base64({ bytes.begin(), bytes.end() });
    }

    /// Whether an optional file exists; a pipe does not count, as reading it would block.
    bool
    is_there(const fs::path &file)
    {
      std::error_code none;
      return fs::is_regular_file(file, none);
    }

    Json
    number_or_null(const std::string &text)
    {
      const double number = parse_number(text);
      return std::isfinite(number) ? Json(number) : Json();
    }

    /// Columns of statistics.csv that are worth a plot, with the times.
    Json
    plots_of(const fs::path &directory)
    {
      std::vector<std::string> names;
      if (!is_there(directory / "statistics.csv"))
        return Json::object();
      std::ifstream table(directory / "statistics.csv");
      std::string   line, cell;
      std::getline(table, line);
      for (std::istringstream cells(line); std::getline(cells, cell, ',');)
        names.push_back(cell);
      Json columns = Json::object();
      if (std::find(names.begin(), names.end(), "time") == names.end())
        return columns;
      while (std::getline(table, line))
      {
        const std::vector<std::string> row = split_trimmed(line, ',');
        for (std::size_t i = 0; i < names.size() && row.size() == names.size(); ++i)
          if (names[i] == "time" || names[i].compare(0, 7, "weight_") == 0
              || names[i].compare(0, 7, "energy_") == 0)
            columns[names[i]].push_back(number_or_null(row[i]));
      }
      return columns;
    }

    /// The surface in a frame: vertices of its triangles, and the triangles by them.
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

    /// Vertices of a surface among nodes that are given as ranges, as summary.json has them: "0-3
    /// 7".
    Json
    vertices_in(const std::string &ranges, const BodySurface &surface)
    {
      Json               vertices = Json::array();
      std::istringstream words(ranges);
      for (std::string word; words >> word;)
      {
        const auto dash  = word.find('-');
        const auto first = decimal_number<unsigned int>(word.substr(0, dash));
        const auto last  = dash == std::string::npos
                               ? first
                               : decimal_number<unsigned int>(word.substr(dash + 1));
        if (!first || !last)
          continue;
        const auto begin = surface.nodes.begin(), end = surface.nodes.end();
        for (auto node = std::lower_bound(begin, end, *first); node != end && *node <= *last;
             ++node)
          vertices.push_back(node - begin);
      }
      return vertices;
    }

    /// Adds names of examples and held vertices from summary.json, if it exists.
    void
    add_names(const fs::path &directory, const BodySurface &surface, Json &data)
    {
      data["examples"] = data["handles"] = Json::array();
      if (!is_there(directory / "summary.json"))
        return;
      const auto text    = read_text_file(directory / "summary.json");
      const Json summary = Json::parse(text.value_or(""), nullptr, false);
      if (!summary.is_object())
        return;
      for (const Json &name : summary.value("example_names", Json::array()))
        data["examples"].push_back(name.is_string() ? name : Json(""));
      for (const Json &handle : summary.value("handles", Json::array()))
        if (handle.is_object() && handle.value("name", Json()).is_string()
            && handle.value("nodes", Json()).is_string())
          data["handles"].push_back(
              { { "name", handle["name"] },
                { "vertices", vertices_in(handle["nodes"].get<std::string>(), surface) } });
    }

    /// A page with its placeholders, names between @, replaced by texts, which are not searched
    /// again.
    std::string
    filled(const std::string &page, const std::map<std::string, std::string> &texts)
    {
      std::string result;
      std::size_t n_filled = 0;
      for (std::size_t i = 0; i < page.size();)
      {
        const auto end = page[i] == '@' ? page.find('@', i + 1) : std::string::npos;
        const auto text
            = end == std::string::npos ? texts.end() : texts.find(page.substr(i, end + 1 - i));
        if (text == texts.end())
          result += page[i++];
        else
        {
          result += text->second;
          i = end + 1;
          ++n_filled;
        }
      }
      if (n_filled != texts.size())
        throw std::runtime_error("The page lacks a place. Install exemplar anew.");
      return result;
    }

    /// JSON escaped for a script element, which < could otherwise end.
    std::string
    in_script(const Json &data)
    {
      std::string text;
      for (const char letter : data.dump(-1, ' ', true, Json::error_handler_t::replace))
        text += letter == '<' ? "\\u003c" : std::string(1, letter);
      return text;
    }

    /// The data of a run in the page.
    struct PageRun
    {
      Json        data;
      std::string topology, frames;
      std::string topology_of_obstacles, obstacles; ///< empty: none
      std::size_t n_frames = 0;
      double      error    = 0.; ///< largest error of a coordinate [m]
    };

    /// Frames of a body, or of obstacles, in files that list the same points.
    class FrameBytes
    {
    public:
      void
      add(const BinaryKind   kind,
          const double       time,
          const fs::path    &file,
          const BodySurface &surface)
      {
        const std::vector<double> places = places_in(file);
        if (n_frames > 0 && places.size() != before.size())
          throw UserError(file.string() + " has other nodes than the first frame.");
        const Vector positions(places.begin(), places.end());
        bytes += *frame_message({ kind, n_frames, n_frames, 0, time }, surface, positions);
        error  = std::max(error, rounding_of_frame(surface, positions));
        moves  = moves || (n_frames > 0 && places != before);
        before = places;
        ++n_frames;
      }

      std::string   bytes;
      double        error    = 0.; ///< the largest of a coordinate [m]
      bool          moves    = false;
      std::uint32_t n_frames = 0;

    private:
      std::vector<double> before;
    };

    /// The bytes of obstacles beside frames: of the first one alone, if they do not move.
    void
    add_obstacles(const std::vector<RunFrame> &frames, PageRun &run)
    {
      const fs::path &first = frames.front().obstacles;
      if (first.empty())
        return;
      const BodySurface surface(places_in(first).size() / 3, polygons_in(first));
      FrameBytes        all;
      for (const RunFrame &frame : frames)
        all.add(BinaryKind::obstacles, frame.time, frame.obstacles, surface);
      run.topology_of_obstacles = *topology_message(surface, BinaryKind::topology_of_obstacles);
      run.obstacles = all.moves ? all.bytes : all.bytes.substr(0, all.bytes.size() / all.n_frames);
      run.error     = std::max(run.error, all.error);
    }

    PageRun
    run_in(const fs::path &directory)
    {
      const std::vector<RunFrame> frames  = frames_of_run(directory);
      const BodySurface           surface = surface_in(frames.front().file);
      FrameBytes                  all;
      for (const RunFrame &frame : frames)
        all.add(BinaryKind::frame, frame.time, frame.file, surface);
      PageRun run;
      run.frames   = std::move(all.bytes);
      run.topology = *topology_message(surface);
      run.n_frames = frames.size();
      run.error    = all.error;
      add_obstacles(frames, run);
      run.data = { { "name", fs::absolute(directory / "").parent_path().filename().string() },
                   { "frames", frames.size() },
                   { "error", run.error },
                   { "plots", plots_of(directory) } };
      add_names(directory, surface, run.data);
      return run;
    }

    /// A script element that holds bytes in base64, under an id by which the page finds it.
    std::string
    element(const std::string &name, const std::size_t i, const std::string &bytes)
    {
      return fmt::format("<script type=\"text/plain\" id=\"{}-{}\">{}</script>\n", name, i,
                         in_base64(bytes));
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
      if (!run.obstacles.empty())
        elements += element("topology-of-obstacles", runs.size(), run.topology_of_obstacles)
                    + element("obstacles", runs.size(), run.obstacles);
      runs.push_back(run.data);
      result.n_frames += run.n_frames;
      result.error = std::max(result.error, run.error);
    }
    const std::string page
        = filled(page_file("export.html"),
                 { { "@THREE@", three_file("three.min.js") },
                   { "@CONTROLS@", three_file("examples/js/controls/OrbitControls.js") },
                   { "@PLAYER@", page_file("player.js") },
                   { "@STYLE@", page_file("style.css") },
                   { "@DATA@", in_script({ { "runs", runs } }) },
                   { "@RUNS@", elements } });
    result.html = mark_of_page + page;
    return result;
  }

  RunPage
  export_page(const std::vector<std::string> &directories, const fs::path &file)
  {
    require_page(file);
    RunPage    page = page_of_runs(directories);
    AtomicFile out(file);
    out.stream() << page.html;
    out.commit();
    return page;
  }
} // namespace Exemplar::Live
