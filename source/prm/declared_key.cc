// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/key_table.h>

#include <algorithm>
#include <ostream>

namespace Exemplar
{
  std::string
  DeclaredKey::path() const
  {
    return Assignment{ subsections, key, "", "" }.path();
  }

  void
  print_keys(std::ostream &out, const std::vector<DeclaredKey> &keys, const bool documented)
  {
    std::vector<std::string> open;
    const auto               indent      = [&] { return std::string(2 * open.size(), ' '); };
    const auto               close_until = [&](const std::vector<std::string> &target)
    {
      while (open.size() > target.size() || !std::equal(open.begin(), open.end(), target.begin()))
      {
        open.pop_back();
        out << indent() << "end\n";
      }
    };
    for (const DeclaredKey &key : keys)
    {
      close_until(key.subsections);
      while (open.size() < key.subsections.size())
      {
        out << (documented && open.empty() ? "\n" : "") << indent() << "subsection "
            << key.subsections[open.size()] << '\n';
        open.push_back(key.subsections[open.size()]);
      }
      if (documented)
        out << indent() << "# " << key.documentation << '\n'
            << indent() << "# Allowed: " << key.allowed
            << ". Default: " << (key.default_value.empty() ? "(empty)" : key.default_value) << '\n';
      out << indent() << "set " << key.key << " = " << key.value << '\n';
    }
    close_until({});
  }
} // namespace Exemplar
