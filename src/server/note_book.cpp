// SPDX-License-Identifier: MIT
#include "server/note_book.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/wall_time.h"

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

/// As a further sentence.
void append(std::string& text, const std::string& sentence) {
  if (!text.empty()) text += ' ';
  text += sentence;
}

bool is_older(const std::string& name) { return name.starts_with("notes-") && name.ends_with(".json"); }

std::vector<std::string> older_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (auto it = fs::directory_iterator(folder, failed); !failed && it != fs::directory_iterator();
       it.increment(failed))
    if (const std::string name = it->path().filename(); is_older(name)) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

/// With a later time where that of the id is not after all that are there: the clock was set back.
std::string name_of_older(const std::string& map_id, const fs::path& folder) {
  const auto began = time_in_name(map_id);
  return "notes-" + (began ? utc_text(time_after(older_names(folder), *began)) : map_id);
}

/// Of the older maps; those of the newest stay, and `newest` does though its id may tell nothing of the time.
void remove_oldest(const fs::path& folder, const std::string& newest) {
  std::vector<std::string> older = older_names(folder);
  std::erase(older, newest);
  std::error_code failed;
  for (std::size_t i = 0; i + NoteBook::kOlderKept <= older.size(); ++i)
    fs::remove(folder / older[i], failed);
}

}  // namespace

NoteBook::NoteBook(Latest<MapNotes>& robot, std::string map_id, const std::optional<std::string>& folder)
    : robot_(robot), map_id_(std::move(map_id)), notes_{map_id_, {}} {
  if (folder) open(*folder);
  tell();
}

void NoteBook::open(const std::string& folder) {
  file_.emplace(folder, "notes.json");
  trouble_ = file_->trouble();
  std::optional<Notes> older;
  notes_.notice = file_->load([&older](const std::string& text) { older = notes_from(text); });
  if (older) notes_.notice = set_aside(*older);
  if (!notes_.notice.empty()) save();
}

/// Returns what people should know of it.
std::string NoteBook::set_aside(const Notes& older) {
  if (older.is_empty()) return older.notice;
  const fs::path folder = fs::path(file_->path()).parent_path();
  const std::string name = file_->free_name(name_of_older(older.map_id, folder), ".json");
  const std::string what =
      "The robot began a new map. What was drawn on the one before does not hold any more; it is ";
  if (!file_->set_aside(name)) return what + "still in " + file_->path() + '.';
  remove_oldest(folder, name);
  return what + "kept as " + name + '.';
}

Notes NoteBook::notes() const {
  const std::lock_guard lock(mutex_);
  Notes notes = notes_;
  const std::string& trouble = trouble_now();
  if (!trouble.empty() && trouble != dismissed_)
    append(notes.notice, "Nothing is saved until this is mended: " + trouble + '.');
  return notes;
}

NoteBook::Refused NoteBook::change(const std::function<Refused(Notes&)>& edit) {
  const std::lock_guard lock(mutex_);
  Notes changed = notes_;
  if (auto refusal = edit(changed)) return refusal;
  notes_ = std::move(changed);
  save();
  tell();
  return std::nullopt;
}

void NoteBook::save() {
  if (!file_) return;
  try {
    file_->write(notes_text(notes_));
  } catch (const std::exception& error) {
    trouble_ = error.what();
    return;
  }
  if (!trouble_.empty()) dismissed_.clear();
  trouble_.clear();
}

void NoteBook::add_notice(const std::string& notice) {
  change([&](Notes& notes) -> Refused {
    append(notes.notice, notice);
    return std::nullopt;
  });
}

void NoteBook::tend(const std::string& others_trouble) {
  const std::lock_guard lock(mutex_);
  const std::string before = trouble_now();
  others_trouble_ = others_trouble;
  if (!trouble_.empty()) save();
  if (trouble_now() == before) return;
  dismissed_.clear();
  tell();
}

std::string NoteBook::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_now();
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
  return change([this](Notes& notes) -> Refused {
    notes.notice.clear();
    dismissed_ = trouble_now();
    return std::nullopt;
  });
}

}  // namespace dynslam
