// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/prm_tools.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <regex>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    int
    lower_case(const char c)
    {
      return std::tolower(static_cast<unsigned char>(c));
    }

    std::size_t
    edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<std::size_t> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0);
      for (std::size_t i = 1; i <= a.size(); ++i)
      {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
          const std::size_t same = diagonal + (lower_case(a[i - 1]) != lower_case(b[j - 1]));
          diagonal               = row[j];
          row[j]                 = std::min({ same, row[j] + 1, row[j - 1] + 1 });
        }
      }
      return row.back();
    }

    std::string
    nearest_path(const std::string &path, const std::vector<DeclaredKey> &keys)
    {
      std::string best;
      std::size_t best_distance = std::string::npos;
      for (const DeclaredKey &key : keys)
        if (const std::size_t distance = edit_distance(path, key.path()); distance < best_distance)
        {
          best          = key.path();
          best_distance = distance;
        }
      return best;
    }

    /// The bounds of a pattern; the extreme ones of the type are none.
    std::string
    bounds_in_words(const std::string &low, const std::string &high)
    {
      if (low == "1e-300") // "greater than 0", as bounds of patterns are inclusive
        return " > 0";
      if (low == "-MAX_DOUBLE" || low == "-2147483648")
        return "";
      if (high == "MAX_DOUBLE" || high == "2147483647")
        return " >= " + low;
      return " in " + low + " ... " + high;
    }

    /// deal.II describes a pattern for machines.
    std::string
    allowed_in_words(const std::string &pattern)
    {
      static const std::regex selection(R"(\[Selection (.*?) ?\])"), bar(R"(\|)"),
          number(R"(\[(Double|Integer range) ([^ ]+)\.\.\.([^ ]+) \(inclusive\)\])");
      const bool  is_list = pattern.compare(0, 8, "[List of") == 0;
      std::smatch match;
      if (std::regex_match(pattern, match, selection))
        return std::regex_replace(match[1].str(), bar, ", ");
      if (std::regex_search(pattern, match, number))
      {
        const std::string noun   = match[1] == "Double" ? "number" : "integer";
        const std::string bounds = bounds_in_words(match[2], match[3]);
        if (is_list) // all lists of numbers are vectors
          return "three " + noun + "s" + bounds + " separated by commas";
        return (noun == "number" ? "a " : "an ") + noun + bounds;
      }
      if (pattern.find("[FileName") != std::string::npos)
        return is_list ? "file names separated by commas" : "a file name";
      if (pattern == "[Bool]")
        return "true or false";
      return is_list ? "names separated by commas" : "any text";
    }

    void
    collect_keys(const Json               &node,
                 std::vector<std::string> &subsections,
                 std::vector<DeclaredKey> &keys)
    {
      for (const auto &[name, content] : node.items())
        if (content.contains("pattern_description"))
        {
          const std::string pattern = content.at("pattern_description");
          keys.push_back({ subsections, name, content.at("value"), content.at("default_value"),
                           content.at("documentation"), allowed_in_words(pattern),
                           pattern.find("[FileName") != std::string::npos,
                           pattern.compare(0, 8, "[List of") == 0 });
        }
        else
        {
          subsections.push_back(name);
          collect_keys(content, subsections, keys);
          subsections.pop_back();
        }
    }

    /// A file name, absolute if there is a directory to start from; refused if a scene file could not hold it.
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
        throw UserError("The path " + path + " holds one of the signs " + unwanted
                        + " which mean something else in scene files. Rename the file or its "
                          "directory.");
      return path;
    }

    std::string
    absolute_files(const DeclaredKey           &key,
                   const std::string           &value,
                   const std::filesystem::path &directory)
    {
      if (!key.is_list)
        return value.empty() ? value : absolute_file(value, directory, "#");
      std::string files;
      for (const std::string &file : split_trimmed(value, ','))
        files += (files.empty() ? "" : ", ") + absolute_file(file, directory, "#,");
      return files;
    }

    void
    set_value(dealii::ParameterHandler &prm,
              const DeclaredKey        &key,
              const Assignment         &assignment,
              const std::string        &value)
    {
      for (const std::string &subsection : key.subsections)
        prm.enter_subsection(subsection);
      bool allowed = true;
      try
      {
        prm.set(key.key, value);
      }
      catch (const dealii::ExceptionBase &)
      {
        allowed = false;
      }
      for (std::size_t i = 0; i < key.subsections.size(); ++i)
        prm.leave_subsection();
      if (!allowed)
        throw UserError(assignment.place + ": " + key.path() + " = '" + value
                        + "' is not allowed. Allowed: " + key.allowed + ". Default: '"
                        + key.default_value + "'.");
    }

  } // namespace

  std::string
  DeclaredKey::path() const
  {
    return Assignment{ subsections, key, "", "" }.path();
  }

  void
  declare_input_file(dealii::ParameterHandler &prm,
                     const std::string        &key,
                     std::string              &value,
                     const std::string        &documentation)
  {
    prm.add_parameter(key, value, documentation, dealii::Patterns::FileName());
  }

  void
  declare_input_files(dealii::ParameterHandler &prm,
                      const std::string        &key,
                      std::vector<std::string> &values,
                      const std::string        &documentation)
  {
    prm.add_parameter(key, values, documentation,
                      dealii::Patterns::List(dealii::Patterns::FileName()));
  }

  std::vector<DeclaredKey>
  declared_keys(const dealii::ParameterHandler &prm)
  {
    std::stringstream text;
    prm.print_parameters(text, dealii::ParameterHandler::JSON
                                   | dealii::ParameterHandler::KeepDeclarationOrder);
    std::vector<DeclaredKey> keys;
    std::vector<std::string> subsections;
    collect_keys(Json::parse(text), subsections, keys);
    return keys;
  }

  void
  apply_assignments(dealii::ParameterHandler      &prm,
                    const std::vector<Assignment> &assignments,
                    const std::filesystem::path   &directory)
  {
    const std::vector<DeclaredKey> keys = declared_keys(prm);
    for (const Assignment &assignment : assignments)
    {
      const auto key
          = std::find_if(keys.begin(), keys.end(),
                         [&](const DeclaredKey &k) { return k.path() == assignment.path(); });
      if (key == keys.end())
        throw UnknownKey(assignment.place + ": there is no parameter '" + assignment.path()
                         + "'. Did you mean '" + nearest_path(assignment.path(), keys)
                         + "'? exemplar --print-parameters lists them all.");
      set_value(prm, *key, assignment,
                key->is_input_file ? absolute_files(*key, assignment.value, directory)
                                   : assignment.value);
    }
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
