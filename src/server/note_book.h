// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "pipe/latest.h"
#include "server/access/state_file.h"
#include "server/notes.h"

namespace dynslam {

/// The id of a map that begins now, by the wall's clock, UTC: "20261126-144501".
std::string new_map_id();

/// Keeps what people draw on the map, and tells the robot. Each start of the program begins a new map: what
/// was drawn on an older one is set aside, as is what cannot be read, and a notice says so.
///
/// In the folder are `notes.json`, `notes-<map id>.json` of the newest older maps, and
/// `notes.json.damaged`. Any thread; changes wait for the disk.
class NoteBook {
 public:
  static constexpr std::size_t kOlderKept = 10;

  struct Refusal {
    /// 404, 409 (there is one of that name, or too many), 412 (only something new was to be kept), 422, or
    /// 507 (not saved).
    int status = 0;
    std::string why;  ///< one sentence
  };
  /// Nothing when it was done.
  using Refused = std::optional<Refusal>;

  /// `folder`: for these alone; none: all is forgotten at the end. `robot` must outlive this. Throws
  /// InputError, in one line, when the folder cannot be used.
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
  Refused dismiss_notice();

 private:
  Refused change(const std::function<Refused(Notes&)>& edit);
  void open(const std::string& folder);
  std::optional<Notes> take_older();
  std::string set_aside(const Notes& older) const;
  void tell() { robot_.put(notes_.for_robot()); }

  Latest<MapNotes>& robot_;
  const std::string map_id_;
  mutable std::mutex mutex_;
  Notes notes_;
  std::optional<StateFile> file_;
};

}  // namespace dynslam
