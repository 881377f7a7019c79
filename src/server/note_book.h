// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "io/state_file.h"
#include "pipe/latest.h"
#include "server/notes.h"

namespace dynslam {

/// Keeps what people draw on the map, and tells the robot. Each start of the program begins a new map: what
/// was drawn on an older one is set aside, as is what cannot be read, and a notice says so. So it does while
/// the disk takes nothing: what is drawn lasts until the program ends then.
///
/// In the folder are `notes.json`, `notes-<map id>.json` of the newest older maps (with a later time where
/// the clock was set back: names sort as they were given), and `notes.json.damaged`. Any thread; changes wait
/// for the disk.
class NoteBook {
 public:
  static constexpr std::size_t kOlderKept = 10;

  struct Refusal {
    /// 404, 409 (there is one of that name, or too many), 412 (only something new was to be kept) or 422.
    int status = 0;
    std::string why;  ///< one sentence
  };
  /// Nothing when it was done.
  using Refused = std::optional<Refusal>;

  /// `folder`: for these alone; none: all is forgotten at the end. `robot` must outlive this. Throws
  /// InputError, in one line, when another program holds the folder.
  NoteBook(Latest<MapNotes>& robot, std::string map_id, const std::optional<std::string>& folder);

  Notes notes() const;
  const std::string& map_id() const { return map_id_; }

  /// What a new drawing does to one of the same name.
  enum class Namesake { kReplace, kKeep };
  /// A place that is home stays so when it is moved.
  Refused put_place(const Destination& place, Namesake older = Namesake::kReplace);
  Refused put_area(const NoGoArea& area, Namesake older = Namesake::kReplace);
  Refused put_home(const Destination& home);
  Refused rename_place(const std::string& name, const std::string& new_name);
  Refused remove_place(const std::string& name);
  Refused remove_area(const std::string& name);
  Refused remove_home();
  /// What it says of a disk that takes nothing comes back when it says something else.
  Refused dismiss_notice();

  /// Something else that people should know.
  void add_notice(const std::string& notice);
  /// Tries to save what could not be saved. `others_trouble`: why something else of the robot cannot be, one
  /// line, empty when all can. To be called now and then.
  void tend(const std::string& others_trouble);
  /// Why not all is saved, one line; empty when it is.
  std::string trouble() const;

 private:
  Refused change(const std::function<Refused(Notes&)>& edit);
  void open(const std::string& folder);
  std::string set_aside(const Notes& older);
  void save();
  const std::string& trouble_now() const { return trouble_.empty() ? others_trouble_ : trouble_; }
  void tell() { robot_.put(notes_.for_robot()); }

  Latest<MapNotes>& robot_;
  const std::string map_id_;
  mutable std::mutex mutex_;
  Notes notes_;
  std::optional<StateFile> file_;
  std::string trouble_, others_trouble_;
  std::string dismissed_;  ///< trouble that nobody wants to read again
};

}  // namespace dynslam
