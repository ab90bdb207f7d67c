// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/prm/remedies.h>

#include <deal.II/base/patterns.h>

#include <algorithm>
#include <memory>
#include <ostream>
#include <set>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// The absolute name of one file. Throws UserError for characters in `unwanted` or unprintable
    /// ones.
    std::string
    absolute_file(const std::string           &file,
                  const std::filesystem::path &directory,
                  const std::string           &unwanted)
    {
      const std::string path
          = directory.empty()
                ? file
                : std::filesystem::absolute(directory / file).lexically_normal().string();
      if (path.find_first_of(unwanted) != std::string::npos)
        throw UserError("The path " + path
                        + (path.find('#') == std::string::npos
                               ? " holds a comma, which separates the names of a list"
                               : " holds a #, which begins a comment in scene files")
                        + ". Rename the file or its directory.");
      if (find_unprintable(path) != std::string::npos)
        throw UserError("The path " + path
                        + " holds bytes that are no text in UTF-8, which a scene file cannot hold. "
                          "Rename the file or its directory.");
      return path;
    }

    /// The name of an input file, or a list of names separated by commas, made absolute if
    /// `directory` is not empty. Throws UserError for a name that a scene file cannot hold.
    std::string
    absolute_files(const std::string           &value,
                   const bool                   is_list,
                   const std::filesystem::path &directory)
    {
      if (!is_list)
        return value.empty() ? value : absolute_file(value, directory, "#");
      std::string files;
      for (const std::string &file : split_trimmed(value, ','))
        files += (files.empty() ? "" : ", ") + absolute_file(file, directory, "#,");
      return files;
    }

    std::string
    bounds_in_words(const Bounds &bounds)
    {
      std::ostringstream words;
      if (bounds.low == Bounds::positive().low)
        words << " > 0";
      else if (bounds.low == Bounds().low)
        return "";
      else if (bounds.high == Bounds().high)
        words << " >= " << bounds.low;
      else
        words << " in " << bounds.low << " ... " << bounds.high;
      return words.str();
    }

    std::string
    three_in_words(const std::string &nouns, const Bounds &bounds)
    {
      return "three " + nouns + bounds_in_words(bounds) + " separated by commas";
    }

    dealii::Patterns::Double
    real_number(const Bounds &bounds)
    {
      return { bounds.low, bounds.high };
    }

    dealii::Patterns::Integer
    whole_number(const Bounds &bounds)
    {
      return { static_cast<int>(bounds.low), bounds.high == Bounds().high
                                                 ? std::numeric_limits<int>::max()
                                                 : static_cast<int>(bounds.high) };
    }
  } // namespace

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

  void
  KeyTable::enter_subsection(const std::string &name)
  {
    subsections.push_back(name);
  }

  void
  KeyTable::leave_subsection()
  {
    subsections.pop_back();
  }

  void
  KeyTable::insert(DeclaredKey declared, const Setter &set)
  {
    declared.subsections = subsections;
    declared.value       = declared.default_value;
    // insert after the last key of the present subsection, or else of the enclosing one
    std::size_t position = entries.size(), depth = 0;
    for (std::size_t i = 0; i < entries.size(); ++i)
    {
      const auto       &other = entries[i].declared.subsections;
      const std::size_t common
          = std::mismatch(other.begin(), other.end(), subsections.begin(), subsections.end()).first
            - other.begin();
      if (common > 0 && common >= depth)
      {
        depth    = common;
        position = i + 1;
      }
    }
    entries.insert(entries.begin() + position, { std::move(declared), set });
  }

  template <typename Value, typename Pattern>
  void
  KeyTable::add_pattern(DeclaredKey    declared,
                        Value         &value,
                        const Pattern &pattern,
                        const bool     takes_semicolons)
  {
    using namespace dealii::Patterns::Tools;
    declared.default_value = Convert<Value>::to_string(value, pattern);
    insert(std::move(declared),
           [&value, pattern, takes_semicolons](std::string text)
           {
             if (takes_semicolons)
               std::replace(text.begin(), text.end(), ';', ',');
             const bool allowed = pattern.match(text);
             if (allowed)
               value = Convert<Value>::to_value(text, pattern);
             return allowed;
           });
  }

  void
  KeyTable::add(const std::string &key,
                double            &value,
                const std::string &documentation,
                const Bounds      &bounds)
  {
    add_pattern({ {}, key, "", "", documentation, "a number" + bounds_in_words(bounds) }, value,
                real_number(bounds));
  }

  void
  KeyTable::add(const std::string &key,
                unsigned int      &value,
                const std::string &documentation,
                const Bounds      &bounds)
  {
    add_pattern({ {}, key, "", "", documentation, "an integer" + bounds_in_words(bounds) }, value,
                whole_number(bounds));
  }

  void
  KeyTable::add(const std::string &key, bool &value, const std::string &documentation)
  {
    add_pattern({ {}, key, "", "", documentation, "true or false" }, value,
                dealii::Patterns::Bool());
  }

  void
  KeyTable::add(const std::string &key,
                std::string       &value,
                const std::string &documentation,
                const std::string &separator)
  {
    add_pattern({ {}, key, "", "", documentation, "any text", false, false, separator }, value,
                dealii::Patterns::Anything());
  }

  void
  KeyTable::add(const std::string     &key,
                std::array<double, 3> &value,
                const std::string     &documentation,
                const Bounds          &bounds)
  {
    add_pattern({ {}, key, "", "", documentation, three_in_words("numbers", bounds), false, true },
                value, dealii::Patterns::List(real_number(bounds), 3, 3), true);
  }

  void
  KeyTable::add(const std::string           &key,
                std::array<unsigned int, 3> &value,
                const std::string           &documentation,
                const Bounds                &bounds)
  {
    add_pattern({ {}, key, "", "", documentation, three_in_words("integers", bounds), false, true },
                value, dealii::Patterns::List(whole_number(bounds), 3, 3), true);
  }

  void
  KeyTable::add_names(const std::string        &key,
                      std::vector<std::string> &value,
                      const std::string        &documentation)
  {
    add_pattern({ {}, key, "", "", documentation, "names separated by commas", false, true }, value,
                dealii::Patterns::List(dealii::Patterns::Anything()));
  }

  void
  KeyTable::add_file(const std::string &key, std::string &value, const std::string &documentation)
  {
    add_pattern({ {}, key, "", "", documentation, "a file name", true }, value,
                dealii::Patterns::FileName());
  }

  void
  KeyTable::add_files(const std::string        &key,
                      std::vector<std::string> &value,
                      const std::string        &documentation)
  {
    add_pattern({ {}, key, "", "", documentation, "file names separated by commas", true, true },
                value, dealii::Patterns::List(dealii::Patterns::FileName()));
  }

  void
  KeyTable::add_choices(const std::string              &key,
                        std::vector<std::string>       &value,
                        const std::vector<std::string> &names,
                        const std::string              &documentation)
  {
    insert({ {},
             key,
             "",
             joined(value),
             documentation,
             "one or more of " + joined(names) + ", each once, separated by commas",
             false,
             true },
           [&value, names](const std::string &text)
           {
             const std::vector<std::string> chosen = split_trimmed(text, ',');
             const std::set<std::string>    once(chosen.begin(), chosen.end());
             const bool                     allowed
                 = !chosen.empty() && once.size() == chosen.size()
                   && std::all_of(chosen.begin(), chosen.end(),
                                  [&](const std::string &name)
                                  { return std::count(names.begin(), names.end(), name) > 0; });
             if (allowed)
               value = chosen;
             return allowed;
           });
  }

  void
  KeyTable::add_choice(const std::string              &key,
                       const std::string              &name,
                       const std::vector<std::string> &names,
                       const std::string              &documentation,
                       const Setter                   &set)
  {
    insert({ {}, key, "", name, documentation, joined(names) }, set);
  }

  std::vector<DeclaredKey>
  KeyTable::keys() const
  {
    std::vector<DeclaredKey> all;
    for (const Entry &entry : entries)
      all.push_back(entry.declared);
    return all;
  }

  bool
  KeyTable::declares(const std::string &path) const
  {
    return index_of(path) < entries.size();
  }

  std::size_t
  KeyTable::index_of(const std::string &path) const
  {
    return std::find_if(entries.begin(), entries.end(),
                        [&](const Entry &entry) { return entry.declared.path() == path; })
           - entries.begin();
  }

  const std::string &
  KeyTable::get(const std::string &path) const
  {
    return entries.at(index_of(path)).declared.value;
  }

  void
  KeyTable::set(const std::string &path, const std::string &text)
  {
    Entry &entry = entries.at(index_of(path));
    if (!entry.set(text))
      throw std::logic_error(path + " = '" + text + "' is not allowed");
    entry.declared.value = text;
  }

  void
  KeyTable::apply(const std::vector<Assignment> &assignments,
                  const std::filesystem::path   &directory)
  {
    for (const Assignment &assignment : assignments)
    {
      const std::size_t index = index_of(assignment.path());
      if (index == entries.size())
        throw UnknownKey(
            assignment.place + ": there is no parameter '" + assignment.path() + "'. "
            + remedy_of_key(assignment.path(), keys(),
                            assignment.place == "--set" ? "=" + assignment.value : ""));
      DeclaredKey      &key   = entries[index].declared;
      const std::string value = key.is_input_file
                                    ? absolute_files(assignment.value, key.is_list, directory)
                                    : assignment.value;
      if (!entries[index].set(value)) // remedies may overwrite the variable, no longer used
        throw UserError(assignment.place + ": " + key.path() + " = '" + value
                        + "' is not allowed. Allowed: " + key.allowed + ". Default: '"
                        + key.default_value + "'."
                        + remedy_of_value(key, value, entries[index].set));
      key.value = value;
    }
  }
} // namespace Exemplar
