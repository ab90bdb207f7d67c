// SPDX-License-Identifier: GPL-3.0-or-later
// Format: MSC Nastran, "Quick Reference Guide", bulk data entries in free, small and large field.
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_builder.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// An entry of the bulk data: its name in capitals, and its fields without the name.
    struct NastranCard
    {
      std::string              name;
      std::vector<std::string> fields;
      std::size_t              line; ///< of the file, counted from 1
    };

    class NastranReader
    {
    public:
      NastranReader(const std::string &bytes, std::string name)
          : name(std::move(name)), builder([this](const std::string &message) { fail(message); })
      {
        std::string text = bytes;
        for (std::size_t i = 0; (i = text.find('\r', i)) != text.npos;)
          text.replace(i, i + 1 < text.size() && text[i + 1] == '\n' ? 2 : 1, "\n");
        if (text.find('\0') != text.npos)
          fail("it has bytes that are no text. A Nastran mesh is a text: save it as one.");
        split_cards(text);
      }

      MshFile
      read()
      {
        std::vector<const NastranCard *> elements;
        for (const NastranCard &card : cards)
        {
          line = card.line;
          if (card.name == "GRID")
            add_grid(card);
          else if (card.name == "CTETRA" || card.name == "CTRIA3")
            elements.push_back(&card);
          else if (card.name == "CHEXA" || card.name == "CPENTA" || card.name == "CPYRAM"
                   || card.name == "INCLUDE" || card.name == "RINGAX" || card.name == "EGRID")
            fail(card.name
                 + " is not read. Bodies are of CTETRA, in one file: mesh the body with "
                   "tetrahedra.");
          else
            passed.insert(card.name);
        }
        for (const NastranCard *const card : elements)
        {
          line = card->line;
          add_element(*card);
        }
        line = 0;
        if (builder.msh.elements.empty())
          fail("there is no CTETRA. The file has no tetrahedra, or is cut off: save it again.");
        if (!passed.empty())
          builder.note("Other entries are left out: "
                       + joined(std::vector<std::string>(passed.begin(), passed.end())) + ".");
        return std::move(builder.msh);
      }

    private:
      [[noreturn]] void
      fail(const std::string &message) const
      {
        throw UserError(name + (line > 0 ? fmt::format(", line {}: ", line) : ": ") + message);
      }

      static bool
      goes_on(const std::string &text)
      {
        return text.empty() || text[0] == '+' || text[0] == '*';
      }

      /// The fields of a line with its first one.
      std::vector<std::string>
      fields_of(const std::string &text) const
      {
        std::vector<std::string> fields;
        if (text.find(',') != text.npos)
        {
          fields = split_trimmed(text, ',');
          fields.resize(std::min<std::size_t>(fields.size(), 9)); // the tenth joins lines
          return fields;
        }
        const bool        is_large = text.substr(0, 8).find('*') != text.npos;
        const std::size_t width = is_large ? 16 : 8, end = std::min<std::size_t>(text.size(), 72);
        fields.push_back(trim(text.substr(0, 8)));
        for (std::size_t at = 8; at < end; at += width)
          fields.push_back(trim(text.substr(at, std::min(width, end - at))));
        fields.resize(is_large ? 5 : 9);
        return fields;
      }

      void
      split_cards(const std::string &text)
      {
        const std::size_t  begin = in_capitals(text).find("BEGIN BULK");
        std::istringstream lines(text);
        std::size_t        at = 0;
        for (std::string one; std::getline(lines, one);)
        {
          ++line;
          const std::size_t place = at;
          at += one.size() + 1;
          one = one.substr(0, one.find('$'));
          for (std::size_t i = 0; (i = one.find('\t', i)) != one.npos;)
            one.replace(i, 1, std::string(8 - i % 8, ' '));
          if (trim(one).empty() || (begin != text.npos && place <= begin))
            continue;
          std::vector<std::string> fields = fields_of(one);
          if (fields.empty())
            continue;
          std::string first = in_capitals(fields[0]);
          if (first == "ENDDATA")
            break;
          if (!goes_on(first))
          {
            first.erase(std::remove(first.begin(), first.end(), '*'), first.end());
            cards.push_back({ first, {}, line });
          }
          else if (cards.empty())
            fail("this line continues an entry, but there is none before.");
          cards.back().fields.insert(cards.back().fields.end(), fields.begin() + 1, fields.end());
        }
        line = 0;
      }

      const std::string &
      field(const NastranCard &card, const std::size_t i) const
      {
        static const std::string none;
        return i < card.fields.size() ? card.fields[i] : none;
      }

      long long
      integer(const NastranCard &card, const std::size_t i) const
      {
        const auto number = decimal_number<long long>(field(card, i));
        if (!number)
          fail(fmt::format(
              "field {} of {} is {}, but must be a whole number. The file may be cut or "
              "its columns moved: save it again.",
              i + 2, card.name, in_quotes(field(card, i))));
        return *number;
      }

      /// A real number, whose exponent may lack its E: 1.5-3.
      double
      real(const NastranCard &card, const std::size_t i) const
      {
        std::string text = field(card, i);
        if (text.empty())
          return 0.;
        std::replace_if(
            text.begin(), text.end(), [](const char c) { return c == 'd' || c == 'D' || c == 'e'; },
            'E');
        if (const std::size_t sign = text.find_last_of("+-");
            sign != text.npos && sign > 0 && text[sign - 1] != 'E')
          text.insert(sign, "E");
        const double number = parse_number(text);
        if (!std::isfinite(number) || text.find_first_not_of("0123456789.+-E") != text.npos)
          fail(fmt::format("field {} of {} is {}, but must be a number. The file may be cut or its "
                           "columns moved: save it again.",
                           i + 2, card.name, in_quotes(field(card, i))));
        return number;
      }

      void
      add_grid(const NastranCard &card)
      {
        if (!field(card, 1).empty() && integer(card, 1) != 0)
          fail("the node is in the coordinate system " + field(card, 1)
               + ", which is not applied. Save the mesh in the basic system (CP = 0).");
        if (card.fields.size() < 5)
          fail(
              "GRID has fewer than three coordinates. The file is cut off: save or copy it again.");
        builder.add_node(integer(card, 0), { real(card, 2), real(card, 3), real(card, 4) });
      }

      void
      add_element(const NastranCard &card)
      {
        const bool             is_cell = card.name == "CTETRA";
        std::vector<long long> nodes;
        for (std::size_t i = 2; i < (is_cell ? 12 : 5); ++i)
          if (i < (is_cell ? 6 : 5) || !field(card, i).empty())
            nodes.push_back(integer(card, i));
        if (is_cell && nodes.size() != 4 && nodes.size() != 10)
          fail(
              fmt::format("a CTETRA has {} nodes, but must have 4 or 10. Save it with all nodes in "
                          "the middles of edges, or with none.",
                          nodes.size()));
        exchange_last_edges(nodes);
        builder.add_element(nodes.size() == 3   ? MshElementType::triangle
                            : nodes.size() == 4 ? MshElementType::tetrahedron
                                                : MshElementType::quadratic_tetrahedron,
                            nodes, builder.tag(integer(card, 1), "a property (PID)"),
                            integer(card, 0));
      }

      const std::string        name;
      std::size_t              line = 0; ///< of messages; 0: none
      std::vector<NastranCard> cards;
      std::set<std::string>    passed; ///< names of entries that are not read
      MeshBuilder              builder;
    };
  } // namespace

  MshFile
  read_nastran(std::string bytes, const std::string &name)
  {
    return NastranReader(bytes, name).read();
  }
} // namespace Exemplar
