// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/physical_names.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/key_table.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    const std::string forms = "box x0 y0 z0 x1 y1 z1 | sphere x y z r | boundary ID | region ID | "
                              "nodes FILE | vertex N [within D] | group NAME | map FILE [above X]";

    constexpr int surface = 2, volume = 3; // dimensions of boundaries and regions

    struct Words
    {
      std::string kind;
      std::string rest;
    };

    Words
    split(const std::string &text)
    {
      std::istringstream in(text);
      Words              words;
      in >> words.kind >> std::ws;
      std::getline(in, words.rest);
      return words;
    }

    /// A selection as it is written, out of one with brackets, commas or capitals.
    std::string
    usual_form(const std::string &kind, std::string rest)
    {
      for (char &c : rest)
        if (std::string("(),;:={}[]").find(c) != std::string::npos)
          c = ' ';
      std::istringstream in(rest);
      std::string        text = kind;
      for (std::string word; in >> word;)
        text += " " + word;
      return text;
    }

    std::vector<double>
    parse_numbers(const std::string &text, bool &are_all)
    {
      std::istringstream  in(text);
      std::vector<double> values;
      for (double value; in >> value;)
        values.push_back(value);
      are_all = in.eof();
      return values;
    }

    /// n numbers as they are written, out of those with commas; empty for other texts.
    std::string
    remedy_of_numbers(const Words &words, const unsigned int n)
    {
      static const std::regex decimal_comma("(\\d),(\\d)");
      bool                    are_all = false;
      for (const std::string &rest :
           { words.rest, std::regex_replace(words.rest, decimal_comma, "$1.$2") })
        if (const std::string text = usual_form("", rest);
            parse_numbers(text, are_all).size() == n && are_all)
          return " Did you mean '" + words.kind + text + "'?";
      return "";
    }

    std::vector<double>
    numbers(const Words &words, const unsigned int n, const std::string &key)
    {
      bool       are_all = false;
      const auto values  = parse_numbers(words.rest, are_all);
      if (words.rest.find('|') != std::string::npos)
        throw UserError(key + "/Select = '" + words.kind + " " + words.rest
                        + "': there is one selection alone, and | joins none. Make a subsection of "
                          "its own for each.");
      if (!are_all || values.size() != n)
        throw UserError(key + "/Select = '" + words.kind + " " + words.rest + "': '" + words.kind
                        + "' takes " + std::to_string(n)
                        + " numbers, separated by blanks, with points as decimal signs."
                        + remedy_of_numbers(words, n) + " Allowed: " + forms + ".");
      return values;
    }

    /// The box that an inequality means; empty for other texts.
    std::string
    box_of(const std::string &text)
    {
      static const std::regex inequality("([xyz]) *([<>])=? *([-+.0-9eE]+)");
      std::smatch             parts;
      if (text.size() > 100 || !std::regex_match(text, parts, inequality))
        return "";
      std::array<std::string, 6> box{ { "-1e9", "-1e9", "-1e9", "1e9", "1e9", "1e9" } };
      const auto                 c            = static_cast<std::size_t>(parts.str(1)[0] - 'x');
      box.at(parts.str(2) == "<" ? c + 3 : c) = parts.str(3);
      std::string selection                   = "box";
      for (const std::string &bound : box)
        selection += " " + bound;
      return selection;
    }

    /// What to say of a selection that is none.
    std::string
    remedy_of(const Words &words)
    {
      const std::string text = words.kind + " " + words.rest;
      if (const std::string box = box_of(trim(text)); !box.empty())
        return " A part of space is selected by a box around it. Did you mean '" + box + "'?";
      if (text.find_first_not_of("0123456789 ,") == std::string::npos)
        return " Node numbers stand in a file: 'nodes FILE' names it.";
      const std::size_t n_letters = std::min(
          words.kind.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"),
          words.kind.size());
      const std::string letters = words.kind.substr(0, n_letters);
      if (letters == "x" || letters == "y" || letters == "z")
        return " A part of space is selected by a box around it.";
      for (const auto &[other, kind] : { std::pair("physical", "boundary"),
                                         { "surface", "boundary" },
                                         { "face", "boundary" },
                                         { "volume", "region" },
                                         { "material", "region" },
                                         { "node", "nodes" } })
        if (is_near(letters, other))
          return " Did you mean '" + usual_form(kind, text.substr(n_letters)) + "'?";
      const std::string kind = nearest_word(
          letters, { "box", "sphere", "boundary", "region", "nodes", "vertex", "group", "map" });
      return kind.empty() ? ""
                          : " Did you mean '" + usual_form(kind, text.substr(n_letters)) + "'?";
    }

    /// The id that a selection gives or names.
    unsigned int
    id_in(const Words &words, const int dimension, const Mesh &mesh, const std::string &key)
    {
      if (words.rest.empty())
        throw UserError(key + "/Select = '" + words.kind + "' does not say which " + words.kind
                        + ". Write an id or a name behind it, such as '" + words.kind + " 1'.");
      return find_id(mesh.get_contents(), dimension, words.rest,
                     key + "/Select = '" + words.kind + " " + words.rest + "'");
    }

    std::string
    list(const std::set<unsigned int> &ids)
    {
      std::string text;
      for (const unsigned int id : ids)
        text += (text.empty() ? "" : ", ") + std::to_string(id);
      return text;
    }

    template <typename Predicate>
    std::vector<unsigned int>
    nodes_where(const Mesh &mesh, const Predicate &selected)
    {
      std::vector<unsigned int> nodes;
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        if (selected(mesh.get_nodes()[node]))
          nodes.push_back(node);
      return nodes;
    }

    std::vector<unsigned int>
    nodes_in_box(const Mesh &mesh, const std::vector<double> &box)
    {
      return nodes_where(mesh,
                         [&](const dealii::Point<3> &x)
                         {
                           bool inside = true;
                           for (unsigned int d = 0; d < 3; ++d)
                             inside = inside && x[d] >= std::min(box[d], box[d + 3])
                                      && x[d] <= std::max(box[d], box[d + 3]);
                           return inside;
                         });
    }

    std::vector<unsigned int>
    nodes_in_sphere(const Mesh &mesh, const std::vector<double> &sphere)
    {
      const dealii::Point<3> center(sphere[0], sphere[1], sphere[2]);
      return nodes_where(mesh, [&](const dealii::Point<3> &x)
                         { return x.distance(center) <= sphere[3]; });
    }

    std::vector<unsigned int>
    nodes_of_region(const Mesh &mesh, const unsigned int id, const std::string &key)
    {
      const auto            &ids = mesh.get_material_ids();
      std::set<unsigned int> nodes;
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        if (ids[cell] == id)
          nodes.insert(mesh.get_cells()[cell].begin(), mesh.get_cells()[cell].end());
      if (nodes.empty())
        throw UserError(key + ": region " + std::to_string(id) + " has no cells in "
                        + mesh.get_name()
                        + " (present: " + list(std::set<unsigned int>(ids.begin(), ids.end()))
                        + "). Give a Physical Volume that tag, or change " + key + "/Select.");
      return { nodes.begin(), nodes.end() };
    }

    std::vector<unsigned int>
    named_nodes(const Mesh        &mesh,
                const NamedNodes  &named,
                const std::string &name,
                const std::string &key)
    {
      const auto found = named.find(name);
      if (found == named.end())
        throw UserError(key + "/Select: there are no nodes '" + name
                        + "' among the inputs. Hand them in by this name, or read them from a "
                          "file.");
      const std::set<unsigned int> nodes(found->second.begin(), found->second.end());
      if (!nodes.empty() && *nodes.rbegin() >= mesh.n_nodes())
        throw UserError(key + "/Select: the nodes '" + name + "' have the index "
                        + std::to_string(*nodes.rbegin()) + ", but the mesh has "
                        + std::to_string(mesh.n_nodes()) + " nodes. They are counted from 0.");
      return { nodes.begin(), nodes.end() };
    }

    /// What a process has of the nodes that the root has selected in the whole mesh: maybe none.
    std::vector<unsigned int>
    nodes_of_part(const NamedNodes &named, const std::string &text)
    {
      const auto found = named.find(text);
      return found == named.end() ? std::vector<unsigned int>() : found->second;
    }

    [[noreturn]] void
    fail_empty(const Mesh &mesh, const std::string &key, const std::string &text)
    {
      dealii::Point<3> low = mesh.get_nodes()[0], high = low;
      for (const dealii::Point<3> &x : mesh.get_nodes())
        for (unsigned int d = 0; d < 3; ++d)
        {
          low[d]  = std::min(low[d], x[d]);
          high[d] = std::max(high[d], x[d]);
        }
      std::ostringstream message;
      const std::string  doubt = Selection{ text }.doubt();
      message << key << "/Select = '" << text << "' selects no node. The mesh " << mesh.get_name()
              << " lies in the box " << low << "  " << high
              << " [m]; enlarge or move the selection." << (doubt.empty() ? "" : " ") << doubt;
      throw UserError(message.str());
    }
  } // namespace

  void
  Selection::declare(KeyTable &keys, const std::string &what)
  {
    keys.add(
        "Select", text,
        what + ": " + forms
            + ". Boxes (inclusive) and spheres select by rest position [m]; an ID is a number, "
              "or the name of a physical group of the mesh file; a FILE of nodes lists node "
              "numbers of the mesh file. The others select nodes of the boundary by Mesh/Surface: "
              "nearest to its vertices N, from 1 in its file's order, or no farther from them than "
              "D [m] along the surface; on its group NAME; where a painted map, FILE.ply:ATTRIBUTE "
              "or FILE.csv, is above X, or below X; without either above 0.5.",
        " ");
  }

  std::string
  Selection::absolute(const std::string &text, const std::filesystem::path &directory)
  {
    const Words words = split(text);
    if ((words.kind != "nodes" && words.kind != "map") || directory.empty())
      return text;
    return words.kind + " "
           + std::filesystem::absolute(directory / words.rest).lexically_normal().string();
  }

  bool
  Selection::is_boundary() const
  {
    return split(text).kind == "boundary";
  }

  bool
  Selection::is_of_space() const
  {
    const std::string kind = split(text).kind;
    return kind == "box" || kind == "sphere";
  }

  bool
  Selection::is_of_surface() const
  {
    const std::string kind = split(text).kind;
    return kind == "vertex" || kind == "group" || kind == "map";
  }

  std::string
  Selection::map() const
  {
    const Words words = split(text);
    return words.kind == "map" ? words.rest : "";
  }

  std::string
  Selection::file() const
  {
    const Words words = split(text);
    return words.kind == "nodes" ? words.rest : "";
  }

  std::vector<BoundaryFace>
  Selection::faces(const Mesh &mesh, const std::string &key) const
  {
    const unsigned int        id = id_in(split(text), surface, mesh, key);
    std::vector<BoundaryFace> selected;
    std::set<unsigned int>    present;
    for (const BoundaryFace &face : mesh.get_boundary_faces())
    {
      present.insert(face.boundary_id);
      if (face.boundary_id == id)
        selected.push_back(face);
    }
    if (selected.empty() && mesh.exchange().n_processes() == 1)
      throw UserError(
          key + ": boundary id " + std::to_string(id) + " has no faces in " + mesh.get_name()
          + " (present: " + list(present)
          + (mesh.get_contents().elements.size() == mesh.n_cells()
                 ? "), which has no triangles. Select by box, sphere or region; boundary "
                   "ids come from the Physical Surfaces of a mesh file."
                 : "). Give a Physical Surface the tag " + std::to_string(id) + ", or change " + key
                       + "/Select." + remedy_of_geo(mesh.get_contents())));
    return selected;
  }

  std::vector<unsigned int>
  Selection::nodes(const Mesh &mesh, const std::string &key, const NamedNodes &named) const
  {
    if (mesh.exchange().n_processes() > 1)
      return nodes_of_part(named, text);
    const Words               words = split(text);
    std::vector<unsigned int> nodes;
    if (words.kind == "box")
      nodes = nodes_in_box(mesh, numbers(words, 6, key));
    else if (words.kind == "sphere")
      nodes = nodes_in_sphere(mesh, numbers(words, 4, key));
    else if (words.kind == "region")
      nodes = nodes_of_region(mesh, id_in(words, volume, mesh, key), key);
    else if (words.kind == "nodes")
      nodes = named_nodes(mesh, named, words.rest, key);
    else if (is_of_surface())
      nodes = named_nodes(mesh, named, text, key);
    else if (words.kind == "boundary")
    {
      std::set<unsigned int> on_faces;
      for (const BoundaryFace &face : faces(mesh, key))
        on_faces.insert(face.nodes.begin(), face.nodes.end());
      nodes.assign(on_faces.begin(), on_faces.end());
    }
    else if (words.kind.empty())
      throw UserError(key + "/Select is not set. Within subsection " + key.substr(0, key.find('/'))
                      + ", subsection " + key.substr(key.find('/') + 1)
                      + " needs a line 'set Select = boundary 1'; if it is not there, write "
                        "'subsection "
                      + key.substr(key.find('/') + 1)
                      + "' before it and 'end' behind it. Allowed: " + forms + ".");
    else
      throw UserError(key + "/Select = '" + text + "' is not understood." + remedy_of(words)
                      + " Allowed: " + forms + ".");

    if (nodes.empty())
      fail_empty(mesh, key, text);
    return nodes;
  }
} // namespace Exemplar
