// SPDX-License-Identifier: GPL-3.0-or-later
// The binary format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/mesh_inputs.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <set>
#include <unordered_map>

namespace Exemplar
{
  namespace
  {
    const std::string npy_magic = "\x93NUMPY";

    /// Whether the name of a file is in fact a list of numbers.
    bool
    is_list(const std::string &name)
    {
      return name.find_first_not_of("0123456789 ,-:") == std::string::npos;
    }

    /// Reads a list of nodes; messages begin with `key`.
    class NodeListReader
    {
    public:
      NodeListReader(const std::filesystem::path &file,
                     const MshFile               &mesh,
                     const std::string           &mesh_name,
                     const std::string           &key)
          : file(file), mesh_name(mesh_name), key(key)
      {
        for (unsigned int node = 0; node < mesh.node_numbers.size(); ++node)
          index[mesh.node_numbers[node]] = node;
        const auto [first, last]
            = std::minmax_element(mesh.node_numbers.begin(), mesh.node_numbers.end());
        minimum = *first;
        maximum = *last;
      }

      std::vector<unsigned int>
      read()
      {
        std::string reason;
        const auto  bytes = read_text_file(file, &reason);
        if (!bytes)
          throw UserError(
              key + ": the file of nodes " + file.string() + " cannot be read (" + reason + ")."
              + (is_list(file.filename().string())
                     ? " The numbers stand in a file; Select names the file." + remedy
                     : " Give the path of a list of nodes." + missing_file_remedy(file)));
        if (bytes->compare(0, npy_magic.size(), npy_magic) == 0)
          read_npy(*bytes);
        else
          read_text(*bytes);
        if (nodes.empty())
          throw UserError(key + ": " + file.string() + " holds no node number." + remedy);
        return { nodes.begin(), nodes.end() };
      }

    private:
      void
      add(const double number, const std::string &word)
      {
        const auto found = number >= 0. && number < 0x1p53 && number == std::floor(number)
                               ? index.find(static_cast<std::size_t>(number))
                               : index.end();
        if (found == index.end())
          throw UserError(fmt::format(
              "{}: {} in {} is no node number of {}{}{}", key, in_quotes(word), file.string(),
              mesh_name,
              number == 0.
                  ? fmt::format(", whose nodes are counted from {0}: add {0} to all.", minimum)
                  : fmt::format(", whose nodes go up to {}.", maximum),
              remedy));
        nodes.insert(found->second);
      }

      void
      read_text(const std::string &text)
      {
        const std::string separators = " \t\r\n,;";
        for (std::size_t at = 0; (at = text.find_first_not_of(separators, at)) < text.size();)
        {
          const bool        is_comment = text[at] == '#';
          const std::size_t end        = std::min<std::size_t>(
              text.find_first_of(is_comment ? "\r\n" : separators + "#", at), text.size());
          if (!is_comment)
            add_word(text.substr(at, end - at));
          at = end;
        }
      }

      void
      add_word(const std::string &word)
      {
        // numpy.savetxt writes 1.000000000000000000e+00
        const bool   is_decimal = word.find_first_not_of("0123456789.eE+-") == std::string::npos;
        char        *end        = nullptr;
        const double number     = std::strtod(word.c_str(), &end);
        add(is_decimal && end == word.c_str() + word.size() ? number : -1., word);
      }

      [[noreturn]] void
      fail_npy(const std::string &what) const
      {
        throw UserError(key + ": " + file.string() + " " + what
                        + ". Save it by numpy.save() as an array of integers.");
      }

      void
      read_npy(const std::string &bytes)
      {
        // the magic, two bytes of a version, the size of the header in two or four bytes
        const bool        is_first = bytes.size() > 6 && bytes[6] == 1;
        const std::size_t begin    = is_first ? 10 : 12;
        if (bytes.size() < begin)
          fail_npy("is truncated");
        std::uint32_t header_size = 0;
        std::memcpy(&header_size, bytes.data() + 8, begin - 8);
        if (bytes.size() - begin < header_size || header_size > 10000)
          fail_npy("is truncated, or no array");
        const std::string       header = bytes.substr(begin, header_size);
        static const std::regex type_pattern("'descr': *'[<|]([iuf][1248])'");
        std::smatch             type;
        if (header.find("'|b1'") < header.size())
          throw UserError(fmt::format(
              "{}: {} holds True and False. Save the numbers of the nodes that are meant, which "
              "are counted from {}: numpy.save(FILE, numpy.flatnonzero(mask) + {}).",
              key, file.string(), minimum, minimum));
        if (!std::regex_search(header, type, type_pattern))
          fail_npy("holds no numbers of this machine's byte order");
        static const std::regex one_axis("'shape': *\\( *[0-9]*,? *\\)");
        if (type.str(1)[0] == 'f' && !std::regex_search(header, one_axis))
          fail_npy(
              "holds a table of numbers with decimals, such as coordinates, not numbers of nodes");
        const std::string data = bytes.substr(begin + header_size);
        if (data.size() != n_entries(header) * static_cast<std::size_t>(type.str(1)[1] - '0'))
          fail_npy("is truncated, or longer than its header says");
        read_numbers(data, type[1]);
      }

      /// The product of the shape's extents.
      std::size_t
      n_entries(const std::string &header) const
      {
        static const std::regex shape_pattern("'shape': *\\(([0-9, ]*)\\)"), extent("[0-9]+");
        std::smatch             shape;
        if (!std::regex_search(header, shape, shape_pattern))
          fail_npy("has a header without a shape");
        const std::string extents = shape[1];
        double            product = 1.;
        for (std::sregex_iterator one(extents.begin(), extents.end(), extent), end; one != end;
             ++one)
          product *= std::strtod(one->str().c_str(), nullptr);
        if (!(product < 1e15))
          fail_npy("has too large a shape");
        return static_cast<std::size_t>(product);
      }

      void
      read_numbers(const std::string &data, const std::string &type)
      {
        if (type == "i8")
          add_all<std::int64_t>(data);
        else if (type == "i4")
          add_all<std::int32_t>(data);
        else if (type == "i2")
          add_all<std::int16_t>(data);
        else if (type == "u8")
          add_all<std::uint64_t>(data);
        else if (type == "u4")
          add_all<std::uint32_t>(data);
        else if (type == "u2")
          add_all<std::uint16_t>(data);
        else if (type == "f8")
          add_all<double>(data);
        else if (type == "f4")
          add_all<float>(data);
        else
          fail_npy("holds numbers of a type that is not read");
      }

      template <typename Number>
      void
      add_all(const std::string &data)
      {
        for (std::size_t at = 0; at < data.size(); at += sizeof(Number))
        {
          Number number;
          std::memcpy(&number, data.data() + at, sizeof(Number));
          add(static_cast<double>(number), std::to_string(number));
        }
      }

      const std::filesystem::path file;
      const std::string           mesh_name;
      const std::string           key;
      const std::string           remedy
          = " List node numbers of the mesh file, separated by blanks, commas or line breaks; # "
            "begins a comment. Arrays of numpy.save() are read, too.";
      std::unordered_map<std::size_t, unsigned int> index;
      std::size_t                                   minimum = 0; ///< least node number of the mesh
      std::size_t                                   maximum = 0;
      std::set<unsigned int>                        nodes;
    };
  } // namespace

  std::vector<unsigned int>
  read_nodes(const std::filesystem::path &file,
             const MshFile               &mesh,
             const std::string           &mesh_name,
             const std::string           &key)
  {
    return NodeListReader(file, mesh, mesh_name, key).read();
  }
} // namespace Exemplar
