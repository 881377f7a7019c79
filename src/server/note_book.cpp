// SPDX-License-Identifier: MIT
#include "server/note_book.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <utility>

#include "base/error.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;

template <class Named>
auto place_of(std::vector<Named>& all, const std::string& name) {
  return std::lower_bound(all.begin(), all.end(), name,
                          [](const Named& one, const std::string& n) { return one.name < n; });
}

template <class Named>
NoteBook::Refused put(std::vector<Named>& all, const Named& one, std::size_t most, NoteBook::Namesake older) {
  const auto at = place_of(all, one.name);
  if (at != all.end() && at->name == one.name) {
    if (older == NoteBook::Namesake::kKeep)
      return NoteBook::Refusal{412, "there is one of this name already; choose another name"};
    *at = one;
  } else if (all.size() >= most) {
    return NoteBook::Refusal{409, "there are too many; delete some first"};
  } else {
    all.insert(at, one);
  }
  return std::nullopt;
}

template <class Named>
NoteBook::Refused remove(std::vector<Named>& all, const std::string& name) {
  const auto at = place_of(all, name);
  if (at == all.end() || at->name != name) return NoteBook::Refusal{404, "there is nothing of this name"};
  all.erase(at);
  return std::nullopt;
}

NoteBook::Refused refused(const std::optional<std::string>& problem) {
  return problem ? NoteBook::Refused({422, *problem}) : std::nullopt;
}

void move_away(const fs::path& from, const fs::path& to) {
  std::error_code failed;
  fs::rename(from, to, failed);
  if (failed)
    throw InputError("cannot move " + from.string() + " to " + to.string() + ": " + failed.message());
}

/// A clock that is set back may give two maps one id.
std::string free_name(const fs::path& folder, const std::string& stem) {
  std::string name = stem + ".json";
  for (int n = 2; fs::exists(folder / name); ++n) name = stem + '-' + std::to_string(n) + ".json";
  return name;
}

/// Of the older maps; those of the newest stay, and `newest` does though its name may tell of a clock that
/// was wrong.
void remove_oldest(const fs::path& folder, const std::string& newest) {
  std::vector<fs::path> older;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename();
    if (name != newest && name.starts_with("notes-") && name.ends_with(".json"))
      older.push_back(entry.path());
  }
  std::sort(older.begin(), older.end());
  for (std::size_t i = 0; i + NoteBook::kOlderKept <= older.size(); ++i) fs::remove(older[i], failed);
}

}  // namespace

std::string new_map_id() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 40> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y%m%d-%H%M%S", &parts)};
}

NoteBook::NoteBook(Latest<MapNotes>& robot, std::string map_id, const std::optional<std::string>& folder)
    : robot_(robot), map_id_(std::move(map_id)), notes_{map_id_, {}} {
  if (folder) open(*folder);
  tell();
}

/// What is new is saved for the notice; that it cannot be is no reason not to start.
void NoteBook::open(const std::string& folder) {
  file_.emplace(folder, "notes.json");
  if (const auto older = take_older()) notes_.notice = set_aside(*older);
  try {
    if (!notes_.notice.empty()) file_->write(notes_text(notes_));
  } catch (const std::runtime_error&) {
    return;
  }
}

std::optional<Notes> NoteBook::take_older() {
  try {
    const auto text = file_->read();
    return text ? std::optional(notes_from(*text)) : std::nullopt;
  } catch (const InputError& error) {
    notes_.notice = std::string("What was drawn on the map could not be read (") + error.what() +
                    "). It is kept as notes.json.damaged.";
  }
  move_away(file_->path(), file_->path() + ".damaged");
  return std::nullopt;
}

/// Returns what people should know of it.
std::string NoteBook::set_aside(const Notes& older) const {
  if (older.is_empty()) return older.notice;
  const fs::path folder = fs::path(file_->path()).parent_path();
  const std::string name = free_name(folder, "notes-" + older.map_id);
  move_away(file_->path(), folder / name);
  remove_oldest(folder, name);
  return "The robot began a new map. What was drawn on the one before does not hold any more; it is kept "
         "as " +
         name + ".";
}

Notes NoteBook::notes() const {
  const std::lock_guard lock(mutex_);
  return notes_;
}

NoteBook::Refused NoteBook::change(const std::function<Refused(Notes&)>& edit) {
  const std::lock_guard lock(mutex_);
  Notes changed = notes_;
  if (auto refusal = edit(changed)) return refusal;
  try {
    if (file_) file_->write(notes_text(changed));
  } catch (const std::exception& error) {
    return Refusal{507, std::string("it was not saved: ") + error.what()};
  }
  notes_ = std::move(changed);
  tell();
  return std::nullopt;
}

NoteBook::Refused NoteBook::put_place(const Destination& place, Namesake older) {
  if (auto refusal = refused(note_name_problem(place.name))) return refusal;
  if (auto refusal = refused(destination_problem(place))) return refusal;
  return change([&](Notes& notes) {
    const auto at = place_of(notes.places, place.name);
    const bool is_home = at != notes.places.end() && at->name == place.name && notes.home == *at;
    auto refusal = put(notes.places, place, kMostPlaces, older);
    if (is_home && !refusal) notes.home = place;
    return refusal;
  });
}

NoteBook::Refused NoteBook::put_area(const NoGoArea& area, Namesake older) {
  if (auto refusal = refused(note_name_problem(area.name))) return refusal;
  if (auto refusal = refused(area_problem(area))) return refusal;
  return change([&](Notes& notes) { return put(notes.areas, area, kMostAreas, older); });
}

NoteBook::Refused NoteBook::put_home(const Destination& home) {
  if (!home.name.empty())
    if (auto refusal = refused(note_name_problem(home.name))) return refusal;
  if (auto refusal = refused(destination_problem(home))) return refusal;
  return change([&](Notes& notes) -> Refused {
    notes.home = home;
    return std::nullopt;
  });
}

NoteBook::Refused NoteBook::rename_place(const std::string& name, const std::string& new_name) {
  if (auto refusal = refused(note_name_problem(new_name))) return refusal;
  return change([&](Notes& notes) -> Refused {
    const auto at = place_of(notes.places, name);
    if (at == notes.places.end() || at->name != name) return Refusal{404, "there is no place of this name"};
    if (new_name == name) return std::nullopt;
    const auto taken = place_of(notes.places, new_name);
    if (taken != notes.places.end() && taken->name == new_name)
      return Refusal{409, "there is a place of this name already"};
    Destination place = *at;
    if (notes.home == place) notes.home->name = new_name;
    place.name = new_name;
    notes.places.erase(at);
    return put(notes.places, place, kMostPlaces, Namesake::kKeep);
  });
}

NoteBook::Refused NoteBook::remove_place(const std::string& name) {
  return change([&](Notes& notes) { return remove(notes.places, name); });
}

NoteBook::Refused NoteBook::remove_area(const std::string& name) {
  return change([&](Notes& notes) { return remove(notes.areas, name); });
}

NoteBook::Refused NoteBook::remove_home() {
  return change([](Notes& notes) -> Refused {
    notes.home.reset();
    return std::nullopt;
  });
}

NoteBook::Refused NoteBook::dismiss_notice() {
  return change([](Notes& notes) -> Refused {
    notes.notice.clear();
    return std::nullopt;
  });
}

}  // namespace dynslam
