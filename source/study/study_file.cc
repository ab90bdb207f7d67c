// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/number_text.h>
#include <exemplar/study/study_axes.h>
#include <exemplar/study/study_file.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// The values of a study file as text.
    struct Entries
    {
      std::string  scene, base, reference, vary;
      unsigned int repeats = 3;
      double       timeout = 0.;
      unsigned int threads = 1;
      std::string  columns, probe;

      void
      declare(KeyTable &keys)
      {
        keys.add_file("Scene", scene, "The scene that is run. To be set in every study.");
        keys.add("Base", base,
                 "Keys of all runs on top of the scene's: Section/Key=value, separated by "
                 "';'. Input files are relative to the scene. Frames are only written if "
                 "Output/Every is set here.");
        keys.add("Reference", reference,
                 "Keys of the reference run on top of Base. Empty: no reference, and no "
                 "errors.");
        keys.add(
            "Vary", vary,
            "Axes separated by '|', each Section/Key: values; the runs are all combinations. "
            "Values "
            "are separated by ';', without one by commas, without these by blanks. Keys that "
            "change "
            "together are joined by '+', and so are their values. Values that hold separators are "
            "put "
            "in double quotes, here and in Base. To be set in every study.");
        keys.add("Repeats", repeats,
                 "How often each combination is run, for the median of the seconds.", Bounds{ 1 });
        keys.add("Timeout", timeout,
                 "Seconds of processor time after which a run is ended, with the status timeout, "
                 "or thirty "
                 "times as many of the clock; 0: never.",
                 Bounds{ 0. });
        keys.add("Threads", threads, "Threads of each run.", Bounds{ 1, 1024 });
        keys.add("Columns", columns,
                 "Columns of statistics.csv whose values at the end are columns of the "
                 "study's tables, separated by commas: weight_0, reaction_tip_z.");
        keys.add("Probe", probe,
                 "Rest position x, y, z [m], separated by commas, whose displacement at "
                 "the end is in the columns probe_x, probe_y and probe_z [m]: that of the "
                 "nearest node. Empty: no such columns.");
      }
    };

    /// Throws UserError for keys that a study does not have, and for missing ones.
    void
    check_keys(const std::vector<Assignment> &given, const KeyTable &keys, const std::string &file)
    {
      std::vector<std::string> names;
      for (const DeclaredKey &key : keys.keys())
        names.push_back(key.key);
      const Assignment *const vary = find_assignment(given, "Vary");
      for (const Assignment &a : given)
      {
        if (a.subsections.empty() && !keys.declares(a.key))
        {
          const std::string near = nearest_word(a.key, names);
          throw UnknownKey(a.place + ": a study has no key '" + a.key + "'."
                           + (near.empty() ? "" : " Did you mean '" + near + "'?")
                           + " exemplar study --print-parameters lists them all.");
        }
        if (!a.subsections.empty() && vary != nullptr)
          throw UserError(
              a.place + ": a study has no subsections. Keys of all runs stand in Base: "
              + "set Base = " + a.path() + "="
              + (a.value.find(';') == std::string::npos ? a.value : '"' + a.value + '"'));
      }
      for (const std::string key : { "Vary", "Scene" })
        if (const Assignment *found = find_assignment(given, key);
            found == nullptr || found->value.empty())
          throw UserError(file + ": " + key
                          + " is not set. A study has lines 'set Scene = FILE.prm' and 'set Vary = "
                            "Section/Key: value value ...'. If it is a scene, run it by: exemplar "
                          + file);
    }

    std::vector<std::string>
    parse_columns(const std::string &text, const std::string &place)
    {
      std::vector<std::string> columns = split_trimmed(text, ',');
      for (const std::string &column : columns)
        if (column.empty() || std::count(columns.begin(), columns.end(), column) > 1)
          throw UserError(place + ": "
                          + (column.empty() ? "a name is empty." : column + " is there twice.")
                          + " Name columns of statistics.csv, each once, separated by commas.");
      return columns;
    }

    std::optional<dealii::Point<3>>
    parse_probe(const std::string &text, const std::string &place)
    {
      if (text.empty())
        return std::nullopt;
      const std::vector<std::string> parts = split_trimmed(text, ',');
      dealii::Point<3>               point;
      for (unsigned int c = 0; c < 3; ++c)
      {
        point[c] = parts.size() == 3 ? parse_number(parts[c]) : std::nan("");
        if (!std::isfinite(point[c]))
          throw UserError(place + ": '" + text
                          + "' is no point. Write three numbers separated by commas, the rest "
                            "position x, y, z in metres.");
      }
      return point;
    }

    /// Throws UserError for keys that are both set for all runs and varied.
    void
    check_disjoint(const std::vector<Assignment> &base, const std::vector<StudyAxis> &axes)
    {
      for (const StudyAxis &axis : axes)
        for (const std::string &key : axis.keys)
          if (const Assignment *both = find_assignment(base, key); both != nullptr)
            throw UserError(both->place + ": " + key
                            + " is set for all runs, but Vary varies it. Remove it from Base (the "
                              "reference's value belongs in Reference), or from Vary.");
    }
  } // namespace

  Study::Study(const std::filesystem::path &file) : file(file), text(read_prm(file))
  {
    const std::vector<Assignment> given = read_assignments(text, file.string());
    KeyTable                      keys;
    Entries                       entries;
    entries.declare(keys);
    check_keys(given, keys, file.string());
    keys.apply(given, std::filesystem::absolute(file).parent_path());

    const auto place = [&](const std::string &key)
    {
      const Assignment *assignment = find_assignment(given, key);
      return (assignment == nullptr ? file.string() : assignment->place) + ", " + key;
    };
    scene         = entries.scene;
    scene_place   = place("Scene");
    base          = parse_settings(entries.base, place("Base"));
    reference     = parse_settings(entries.reference, place("Reference"));
    vary_place    = place("Vary");
    axes          = parse_axes(entries.vary, vary_place);
    repeats       = entries.repeats;
    timeout       = entries.timeout;
    threads       = entries.threads;
    columns_place = place("Columns");
    columns       = parse_columns(entries.columns, columns_place);
    probe_place   = place("Probe") + ": " + entries.probe;
    probe         = parse_probe(entries.probe, place("Probe"));
    check_disjoint(base, axes);
  }

  std::vector<std::vector<unsigned int>>
  Study::choices() const
  {
    std::vector<std::vector<unsigned int>> all = { {} };
    for (const StudyAxis &axis : axes)
    {
      std::vector<std::vector<unsigned int>> longer;
      for (const auto &choice : all)
        for (unsigned int i = 0; i < axis.values.size(); ++i)
        {
          longer.push_back(choice);
          longer.back().push_back(i);
        }
      all = std::move(longer);
    }
    return all;
  }

  std::vector<Assignment>
  Study::assignments(const std::vector<unsigned int> &choice) const
  {
    std::vector<Assignment> all = { { { "Output" }, "Every", "0", file.string() } };
    all.insert(all.end(), base.begin(), base.end());
    for (unsigned int a = 0; a < choice.size(); ++a)
      for (unsigned int k = 0; k < axes[a].keys.size(); ++k)
      {
        all.push_back(parse_assignment(axes[a].keys[k] + "=", vary_place));
        all.back().value = axes[a].values[choice[a]][k];
      }
    return all;
  }

  std::vector<Assignment>
  Study::reference_assignments() const
  {
    std::vector<Assignment> all = assignments({});
    all.insert(all.end(), reference.begin(), reference.end());
    return all;
  }

  std::vector<DeclaredKey>
  study_keys()
  {
    KeyTable keys;
    Entries  entries;
    entries.declare(keys);
    return keys.keys();
  }
} // namespace Exemplar
