// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/degrees.h>

#include <regex>

namespace Exemplar
{
  namespace
  {
    /// Greatest length of formulas that people write; nested calls in longer texts would take long
    /// to search.
    constexpr std::size_t longest_by_hand = 2000;

    /// The text between the parenthesis at `begin` and its closing one.
    std::string
    in_parentheses(const std::string &text, const std::size_t begin)
    {
      unsigned int depth = 0;
      for (std::size_t i = begin; i < text.size(); ++i)
        if (text[i] == '(')
          ++depth;
        else if (text[i] == ')' && --depth == 0)
          return text.substr(begin + 1, i - begin - 1);
      return "";
    }

    /// A number that looks like degrees, or nothing.
    std::string
    degrees_in(const std::string &argument)
    {
      static const std::regex pi("\\bpi\\b"), number("(^|[^\\w.])([0-9]{2,4})(?![\\w.])");
      if (std::regex_search(argument, pi))
        return "";
      for (std::sregex_iterator found(argument.begin(), argument.end(), number), end; found != end;
           ++found)
      {
        const int  value      = std::stoi((*found)[2]);
        const bool is_divisor = (*found)[1] == "/";
        if (value >= 30 && value % 15 == 0 && !is_divisor)
          return (*found)[2];
      }
      return "";
    }
  } // namespace

  std::vector<AngleInDegrees>
  find_degrees(const std::string &formulas)
  {
    static const std::regex     call("\\b(sin|cos|tan)\\s*\\("), over_180("/\\s*180(?![\\w.])");
    std::vector<AngleInDegrees> all;
    if (formulas.size() > longest_by_hand)
      return all;
    for (std::sregex_iterator found(formulas.begin(), formulas.end(), call), end; found != end;
         ++found)
    {
      const auto        open = static_cast<std::size_t>(found->position() + found->length() - 1);
      const std::string argument = in_parentheses(formulas, open);
      if (const std::string number = degrees_in(argument); !number.empty())
        all.push_back({ (*found)[1], argument, number, std::regex_search(argument, over_180) });
    }
    return all;
  }
} // namespace Exemplar
