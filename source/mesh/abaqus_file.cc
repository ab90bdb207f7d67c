// SPDX-License-Identifier: GPL-3.0-or-later
// Format: Abaqus Keywords Reference Guide; CalculiX CrunchiX USER'S MANUAL.
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_builder.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    struct AbaqusElement
    {
      const char  *begin; ///< of the name of its type
      unsigned int type;  ///< gmsh's
    };

    /// By the longest beginning, as letters behind it choose a formulation.
    constexpr AbaqusElement abaqus_elements[] = {
      { "C3D4", MshElementType::tetrahedron },
      { "C3D10", MshElementType::quadratic_tetrahedron },
      { "C3D5", 7 },
      { "C3D6", 6 },
      { "C3D8", 5 },
      { "C3D15", 18 },
      { "C3D20", 17 },
      { "CPS3", MshElementType::triangle },
      { "CPE3", MshElementType::triangle },
      { "S3", MshElementType::triangle },
      { "STRI3", MshElementType::triangle },
      { "R3D3", MshElementType::triangle },
      { "M3D3", MshElementType::triangle },
      { "SFM3D3", MshElementType::triangle },
      { "DS3", MshElementType::triangle },
      { "CPS6", MshElementType::quadratic_triangle },
      { "CPE6", MshElementType::quadratic_triangle },
      { "STRI65", MshElementType::quadratic_triangle },
      { "S6", MshElementType::quadratic_triangle },
      { "M3D6", MshElementType::quadratic_triangle },
      { "SFM3D6", MshElementType::quadratic_triangle },
      { "CPS4", 3 },
      { "S4", 3 },
      { "T3D2", MshElementType::line },
      { "B31", MshElementType::line },
      { "T3D3", MshElementType::quadratic_line },
      { "B32", MshElementType::quadratic_line },
    };

    /// Keywords that put nodes and elements elsewhere than they stand, or make others.
    const std::map<std::string, std::string> refused_keywords{
      { "INCLUDE", "Put the text of the other file in its place" },
      { "TRANSFORM", "Write the mesh without it" },
      { "SYSTEM", "Write coordinates in the global system" },
      { "PART", "Export the mesh without parts and assemblies: in Abaqus/CAE Model > Edit "
                "Attributes > Do not use parts and assemblies in input files" },
      { "INSTANCE", "Export the mesh without parts and assemblies: in Abaqus/CAE Model > Edit "
                    "Attributes > Do not use parts and assemblies in input files" },
      { "ASSEMBLY", "Export the mesh without parts and assemblies: in Abaqus/CAE Model > Edit "
                    "Attributes > Do not use parts and assemblies in input files" },
      { "NGEN", "Write every node with its coordinates" },
      { "NFILL", "Write every node with its coordinates" },
      { "NCOPY", "Write every node with its coordinates" },
      { "NMAP", "Write every node with its coordinates" },
      { "ELGEN", "Write every element with its nodes" },
      { "ELCOPY", "Write every element with its nodes" },
    };

    /// A set, by the numbers of its nodes or elements.
    struct AbaqusSet
    {
      std::string         name; ///< as it is written first
      std::set<long long> numbers;
    };

    class AbaqusReader
    {
    public:
      AbaqusReader(std::string bytes, const std::string &name)
          : text(std::move(bytes), name),
            builder([this](const std::string &message) { text.fail(message); })
      {
      }

      MshFile
      read()
      {
        if (text.at_end())
          text.fail("the file is empty. Save or copy the mesh again.");
        for (bool more = next_line(); more;)
        {
          if (line[0] != '*')
            text.fail("the line does not begin with a keyword such as *NODE: "
                      + in_quotes(line.substr(0, 40)) + ". Save or copy the mesh again.");
          more = read_block();
        }
        add_elements();
        add_regions();
        add_node_sets();
        add_notes();
        return std::move(builder.msh);
      }

    private:
      struct Element
      {
        unsigned int           type;
        long long              number;
        std::vector<long long> nodes;
      };

      using Options = std::map<std::string, std::string>;

      /// Go to the next line that is neither empty nor a comment; false at the end.
      bool
      next_line()
      {
        while (text.n_bytes_left() > 0)
        {
          line = std::string(text.rest_of_line());
          line.erase(0, line.find_first_not_of(" \t"));
          line.erase(line.find_last_not_of(" \t") + 1);
          if (!line.empty() && line.compare(0, 2, "**") != 0)
            return true;
        }
        line.clear();
        return false;
      }

      /// Go to the next line of data; false if a keyword follows, or nothing.
      bool
      next_data()
      {
        return next_line() && line[0] != '*';
      }

      static std::string
      trimmed(std::string word)
      {
        word.erase(0, std::min(word.find_first_not_of(" \t\""), word.size()));
        word.erase(word.find_last_not_of(" \t\"") + 1);
        return word;
      }

      /// The keyword of this line in capitals without blanks, and its options.
      std::string
      keyword(Options &options)
      {
        while (line.back() == ',' && text.n_bytes_left() > 0) // goes on
        {
          const std::string before = line;
          if (!next_line())
            break;
          line = before + line;
        }
        std::string name;
        for (std::size_t begin = 1; begin <= line.size();)
        {
          const std::size_t end    = std::min(line.find(',', begin), line.size());
          const std::string part   = line.substr(begin, end - begin);
          const std::size_t equals = part.find('=');
          if (begin == 1)
            name = in_capitals(trimmed(part));
          else if (!trimmed(part).empty())
            options[in_capitals(trimmed(part.substr(0, equals)))]
                = equals == part.npos ? "" : trimmed(part.substr(equals + 1));
          begin = end + 1;
        }
        return name;
      }

      /// Read a keyword and its data; returns whether there is a line behind.
      bool
      read_block()
      {
        Options           options;
        const std::string name = keyword(options);
        if (const auto refused = refused_keywords.find(name); refused != refused_keywords.end())
          text.fail("*" + name + " is not read. " + refused->second + ".");
        if (name == "NODE")
          read_nodes(options);
        else if (name == "ELEMENT")
          read_elements(options);
        else if (name == "NSET" || name == "ELSET")
          read_set(name, options);
        else
        {
          if (name != "HEADING")
            passed.insert("*" + name.substr(0, 30));
          while (next_data())
          {
          }
        }
        return !line.empty();
      }

      std::vector<std::string>
      data() const
      {
        std::vector<std::string> words;
        for (std::size_t begin = 0; begin <= line.size();)
        {
          const std::size_t end = std::min(line.find(',', begin), line.size());
          words.push_back(trimmed(line.substr(begin, end - begin)));
          begin = end + 1;
        }
        if (words.size() > 1 && words.back().empty()) // a comma ends the line
          words.pop_back();
        return words;
      }

      static AbaqusSet &
      set_in(std::vector<AbaqusSet> &sets, const std::string &name)
      {
        for (AbaqusSet &set : sets)
          if (in_capitals(set.name) == in_capitals(name))
            return set;
        sets.push_back({ name, {} });
        return sets.back();
      }

      AbaqusSet *
      set_of(std::vector<AbaqusSet> &sets, const Options &options, const std::string &option)
      {
        const auto found = options.find(option);
        return found == options.end() || found->second.empty() ? nullptr
                                                               : &set_in(sets, found->second);
      }

      void
      require_only(const Options               &options,
                   const std::set<std::string> &known,
                   const std::string           &name)
      {
        for (const auto &[option, value] : options)
          if (known.count(option) == 0)
            text.fail("*" + name + " has the option " + in_quotes(option.substr(0, 40))
                      + ", which is not read. Write the mesh without it.");
      }

      void
      read_nodes(const Options &options)
      {
        require_only(options, { "NSET", "SYSTEM" }, "NODE");
        if (const auto system = options.find("SYSTEM");
            system != options.end() && in_capitals(system->second) != "R")
          text.fail("*NODE has SYSTEM=" + system->second.substr(0, 40)
                    + ". Write coordinates in the global rectangular system (SYSTEM=R).");
        AbaqusSet *const set = set_of(node_sets, options, "NSET");
        while (next_data())
        {
          const auto        words  = data();
          const long long   number = text.integer_of(words[0], "the number of a node");
          const std::string what   = fmt::format("a coordinate of node {}", number);
          if (words.size() < 4 || words.size() > 7) // a normal may follow
            text.fail(
                fmt::format("node {} has {} coordinates instead of three. A line of *NODE is: "
                            "number, x, y, z.",
                            number, words.size() - 1));
          if (number < 1)
            text.fail(
                fmt::format("a node has the number {}. Nodes are numbered from 1 on.", number));
          builder.add_node(number, { text.number_of(words[1], what), text.number_of(words[2], what),
                                     text.number_of(words[3], what) });
          if (set != nullptr)
            set->numbers.insert(number);
        }
      }

      unsigned int
      type_of(const std::string &given)
      {
        const std::string    wanted = in_capitals(given);
        const AbaqusElement *found  = nullptr;
        for (const AbaqusElement &kind : abaqus_elements)
        {
          const std::string begin(kind.begin);
          const bool        fits = wanted.rfind(begin, 0) == 0
                            && wanted.find_first_of("0123456789", begin.size()) == wanted.npos;
          if (fits && (found == nullptr || begin.size() > std::string(found->begin).size()))
            found = &kind;
        }
        if (found == nullptr)
          text.fail("elements of the type " + in_quotes(given.substr(0, 40))
                    + " are not read. Mesh with tetrahedra: C3D4 or, with straight edges, C3D10.");
        return found->type;
      }

      void
      read_elements(const Options &options)
      {
        require_only(options, { "TYPE", "ELSET", "SOLID SECTION" }, "ELEMENT");
        const auto type_option = options.find("TYPE");
        if (type_option == options.end())
          text.fail("*ELEMENT has no TYPE. Write TYPE=C3D4, or export the mesh again.");
        const unsigned int type    = type_of(type_option->second);
        const std::size_t  n_nodes = find_msh_element_kind(type)->n_nodes;
        AbaqusSet *const   set     = set_of(element_sets, options, "ELSET");
        while (next_data())
        {
          auto            words  = data();
          const long long number = text.integer_of(words[0], "the number of an element");
          while (words.size() < 1 + n_nodes && next_data())
            for (const std::string &word : data())
              words.push_back(word);
          if (words.size() != 1 + n_nodes)
            text.fail(
                fmt::format("element {} has {} nodes instead of {}, as {} has. Save or copy the "
                            "mesh again.",
                            number, words.size() - 1, n_nodes, type_option->second));
          if (number < 1 || !element_numbers.insert(number).second)
            text.fail(
                fmt::format("element number {} {}. Every element needs its own number, from 1 "
                            "on: export the mesh again.",
                            number, number < 1 ? "is not allowed" : "appears twice"));
          Element element{ type, number, {} };
          for (std::size_t v = 1; v < words.size(); ++v)
            element.nodes.push_back(
                text.integer_of(words[v], fmt::format("a node of element {}", number)));
          exchange_last_edges(element.nodes);
          elements.push_back(std::move(element));
          if (set != nullptr)
            set->numbers.insert(number);
          if (line.empty() || line[0] == '*')
            return;
        }
      }

      void
      read_set(const std::string &kind, const Options &options)
      {
        const bool is_of_nodes = kind == "NSET";
        require_only(options,
                     { kind, "GENERATE", "UNSORTED", "INTERNAL", is_of_nodes ? "ELSET" : kind },
                     kind);
        auto            &sets = is_of_nodes ? node_sets : element_sets;
        AbaqusSet *const set  = set_of(sets, options, kind);
        if (set == nullptr)
          text.fail("*" + kind + " has no name. Write " + kind + "=NAME behind it.");
        const std::string what = "an entry of the set " + in_quotes(set->name);
        if (const auto of_elements = options.find("ELSET");
            is_of_nodes && of_elements != options.end())
          add_nodes_of(*set, of_elements->second, what);
        while (next_data())
        {
          const auto words = data();
          if (options.count("GENERATE") > 0)
          {
            generate(*set, words, what);
            continue;
          }
          for (const std::string &word : words)
            if (!word.empty() && word.find_first_not_of("0123456789") == word.npos)
              set->numbers.insert(text.integer_of(word, what));
            else
              add_other(*set, sets, word, what);
        }
      }

      void
      add_nodes_of(AbaqusSet &set, const std::string &elset, const std::string &what)
      {
        AbaqusSet of_elements;
        add_other(of_elements, element_sets, elset, what);
        for (const Element &element : elements)
          if (of_elements.numbers.count(element.number) > 0)
            set.numbers.insert(element.nodes.begin(), element.nodes.end());
      }

      void
      add_other(AbaqusSet                    &set,
                const std::vector<AbaqusSet> &sets,
                const std::string            &name,
                const std::string            &what)
      {
        for (const AbaqusSet &other : sets)
          if (&other != &set && in_capitals(other.name) == in_capitals(name))
            return set.numbers.insert(other.numbers.begin(), other.numbers.end());
        text.fail(
            what + " is " + in_quotes(name.substr(0, 40))
            + ", which is neither a number nor a set that stands before. Save or copy the mesh "
              "again.");
      }

      void
      generate(AbaqusSet &set, const std::vector<std::string> &words, const std::string &what)
      {
        if (words.size() < 2 || words.size() > 3)
          text.fail(
              "with GENERATE a line of a set is: first, last, step. Save or copy the mesh again.");
        const long long first = text.integer_of(words[0], what),
                        last  = text.integer_of(words[1], what);
        const long long step  = words.size() == 3 ? text.integer_of(words[2], what) : 1;
        const auto      most
            = static_cast<long long>(std::max(builder.msh.nodes.size(), elements.size()));
        if (first < 1 || last < first || step < 1 || (last - first) / step > most)
          text.fail(
              fmt::format("{} to {} in steps of {} are no numbers of this mesh. Save or copy the "
                          "mesh again.",
                          first, last, step));
        for (long long number = first; number <= last; number += step)
          set.numbers.insert(number);
      }

      void
      add_elements()
      {
        for (const Element &element : elements)
          builder.add_element(element.type, element.nodes, 0, element.number);
      }

      /// Tags from names such as REGION_3, which write_mesh_file() gives to regions without one.
      static int
      own_tag(const std::string &name)
      {
        for (const std::string begin : { "REGION_", "BOUNDARY_" })
          if (name.rfind(begin, 0) == 0 && name.size() > begin.size()
              && name.size() < begin.size() + 9
              && name.find_first_not_of("0123456789", begin.size()) == name.npos)
            return std::stoi(name.substr(begin.size()));
        return -1;
      }

      int
      next_tag()
      {
        do
          ++last_tag;
        while (std::any_of(element_sets.begin(), element_sets.end(),
                           [&](const AbaqusSet &set) { return own_tag(set.name) == last_tag; }));
        return last_tag;
      }

      void
      add_regions()
      {
        std::map<long long, std::size_t> index;
        for (std::size_t i = 0; i < elements.size(); ++i)
          index[elements[i].number] = i;
        std::vector<std::size_t> size_of_own(elements.size(), 0); // that of the set that has it
        bool                     overlap = false;
        for (const AbaqusSet &set : element_sets)
        {
          const int own = own_tag(set.name), tag = own >= 0 ? own : next_tag();
          for (const long long number : set.numbers)
          {
            const auto found = index.find(number);
            if (found == index.end())
              text.fail(
                  fmt::format("the set {} has element {}, which the file does not have. Save or "
                              "copy the mesh again.",
                              in_quotes(set.name), number));
            std::size_t &size = size_of_own[found->second];
            overlap           = overlap || size != 0;
            if (size != 0 && size < set.numbers.size())
              continue;
            size                                           = set.numbers.size();
            builder.msh.elements[found->second].physical   = tag;
            builder.msh.elements[found->second].elementary = tag;
          }
          if (own < 0)
            names[tag] = set.name;
        }
        name_regions();
        if (overlap)
          builder.note(text.get_name()
                       + ": elements in several sets belong to the smallest of them as region or "
                         "boundary; of equal ones to the last.");
      }

      void
      name_regions()
      {
        for (const MshElement &element : builder.msh.elements)
          if (const auto named = names.find(element.physical); named != names.end())
            builder.msh
                .physical_names[{ static_cast<int>(find_msh_element_kind(element.type)->dimension),
                                  element.physical }]
                = named->second;
        for (const auto &[tag, name] : names)
        {
          bool is_used = false;
          for (int dimension = 1; dimension <= 3; ++dimension)
            is_used = is_used || builder.msh.physical_names.count({ dimension, tag }) > 0;
          if (!is_used)
            builder.note(text.get_name() + ": the set " + in_quotes(name)
                         + " has no elements of its own, and is left out.");
        }
      }

      void
      add_node_sets()
      {
        long long number = element_numbers.empty() ? 0 : *element_numbers.rbegin();
        int       tag    = 0;
        for (const AbaqusSet &set : node_sets)
        {
          ++tag;
          for (const long long node : set.numbers)
            builder.add_element(MshElementType::point, { node }, tag, ++number);
          builder.msh.physical_names[{ 0, tag }] = set.name;
        }
      }

      void
      add_notes()
      {
        std::string list;
        for (const std::string &keyword : passed)
          list += (list.empty() ? "" : ", ") + keyword;
        if (!list.empty())
          builder.note(text.get_name() + ": " + list.substr(0, 300)
                       + " are passed over; only nodes, elements and their sets are read.");
      }

      MeshText                   text;
      MeshBuilder                builder;
      std::string                line; ///< the one that next_line() went to, empty at the end
      std::vector<Element>       elements;
      std::set<long long>        element_numbers;
      std::vector<AbaqusSet>     node_sets, element_sets;
      std::map<int, std::string> names;
      int                        last_tag = 0;
      std::set<std::string>      passed;
    };
  } // namespace

  MshFile
  read_abaqus(std::string bytes, const std::string &name)
  {
    return AbaqusReader(std::move(bytes), name).read();
  }
} // namespace Exemplar
