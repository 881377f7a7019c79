// SPDX-License-Identifier: MIT
#include "server/note_book.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/io/file_size_limit.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class NoteBookTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "dynslam-notes-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<NoteBook> start(const std::string& map_id) {
    return std::make_unique<NoteBook>(robot_, map_id, folder_.string());
  }
  std::string text(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return out.str();
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  static int status(const NoteBook::Refused& refused) { return refused ? refused->status : 204; }
  MapNotes told() const { return *robot_.get().value; }

  fs::path folder_;
  Latest<MapNotes> robot_;
  const NoGoArea stairs_{"Stairs", {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
};

TEST_F(NoteBookTest, TellsTheRobotOfEachChange) {
  NoteBook book(robot_, "1", std::nullopt);
  EXPECT_TRUE(told().forbidden_map.empty());
  EXPECT_EQ(status(book.put_area(stairs_)), 204);
  EXPECT_EQ(told().forbidden_map, (std::vector<std::vector<Vector2>>{stairs_.corners_map}));
  EXPECT_EQ(status(book.put_area({"Stairs", {{5, 5}, {6, 5}, {6, 6}, {5, 6}}})), 204);
  ASSERT_EQ(told().forbidden_map.size(), 1U) << "the same one, drawn anew";
  EXPECT_EQ(told().forbidden_map[0].size(), 4U);
  EXPECT_EQ(status(book.remove_area("Stairs")), 204);
  EXPECT_TRUE(told().forbidden_map.empty());
  EXPECT_EQ(status(book.remove_area("Stairs")), 404);

  EXPECT_EQ(status(book.put_home({{1, 2}, {}, "Dock"})), 204);
  EXPECT_EQ(told().home, (Destination{{1, 2}, {}, "Dock"}));
  EXPECT_EQ(status(book.remove_home()), 204);
  EXPECT_FALSE(told().home);
}

TEST_F(NoteBookTest, PlacesAreByNameAndCanBeRenamed) {
  NoteBook book(robot_, "1", std::nullopt);
  const Destination dock{{1, 2}, 0.5, "Dock"};
  EXPECT_EQ(status(book.put_place({{0, 0}, {}, "Sofa"})), 204);
  EXPECT_EQ(status(book.put_place(dock)), 204);
  EXPECT_EQ(status(book.put_home(dock)), 204);
  EXPECT_EQ(status(book.rename_place("Dock", "Sofa")), 409);
  EXPECT_EQ(status(book.rename_place("Attic", "Loft")), 404);
  EXPECT_EQ(status(book.rename_place("Dock", "")), 422);
  EXPECT_EQ(status(book.rename_place("Dock", "Zoo")), 204);
  const Notes notes = book.notes();
  EXPECT_EQ(notes.places, (std::vector<Destination>{{{0, 0}, {}, "Sofa"}, {{1, 2}, 0.5, "Zoo"}}));
  EXPECT_EQ(notes.home->name, "Zoo") << "it is the same place";
  EXPECT_EQ(status(book.put_place({{3, 4}, {}, "Zoo"})), 204);
  EXPECT_EQ(book.notes().home->point_map, Vector2(3, 4)) << "wherever that is";
  EXPECT_EQ(status(book.put_home({{0, 0}, {}, {}})), 204);
  EXPECT_EQ(status(book.put_place(dock)), 204);
  EXPECT_EQ(book.notes().home->point_map, Vector2(0, 0));
  EXPECT_EQ(status(book.remove_place("Dock")), 204);
  EXPECT_EQ(status(book.remove_place("Zoo")), 204);
  EXPECT_EQ(status(book.remove_place("Zoo")), 404);
}

TEST_F(NoteBookTest, RefusesWhatCannotBe) {
  NoteBook book(robot_, "1", std::nullopt);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::string too_long(41, 'x'), robots = "\xf0\x9f\xa4\x96";
  for (const std::string& name :
       {std::string(), too_long, std::string("a\nb"), std::string("\xff"), std::string("a/b"),
        std::string("a\\b"), std::string(".."), std::string(" "), std::string("a "), std::string(" a")}) {
    EXPECT_EQ(status(book.put_place({{0, 0}, {}, name})), 422) << name;
    EXPECT_EQ(status(book.put_area({name, stairs_.corners_map})), 422) << name;
  }
  std::string forty;
  for (int i = 0; i < 40; ++i) forty += robots;
  EXPECT_EQ(status(book.put_place({{0, 0}, {}, forty})), 204) << "characters, not bytes";
  EXPECT_EQ(status(book.put_place({{kNaN, 0}, {}, "p"})), 422);
  EXPECT_EQ(status(book.put_place({{0, 1000.1}, {}, "p"})), 422);
  EXPECT_EQ(status(book.put_place({{0, 0}, kNaN, "p"})), 422);
  EXPECT_EQ(status(book.put_home({{0, -1e9}, {}, {}})), 422);
  EXPECT_EQ(status(book.put_area({"a", {{0, 0}, {1, 1}}})), 422);
  EXPECT_EQ(status(book.put_area({"a", std::vector<Vector2>(65, Vector2::Zero())})), 422);
  EXPECT_EQ(status(book.put_area({"a", {{0, 0}, {1, 1}, {kNaN, 0}}})), 422);
  EXPECT_EQ(status(book.put_area({"a", {{0, 0}, {1, 1}, {0, 1}, {1, 0}}})), 204) << "it may cross itself";
}

TEST_F(NoteBookTest, HasRoomForSoManyAndNoMore) {
  NoteBook book(robot_, "1", std::nullopt);
  for (int i = 0; i < 64; ++i) {
    EXPECT_EQ(status(book.put_place({{0, 0}, {}, std::to_string(i)})), 204);
    EXPECT_EQ(status(book.put_area({std::to_string(i), stairs_.corners_map})), 204);
  }
  EXPECT_EQ(status(book.put_place({{0, 0}, {}, "more"})), 409);
  EXPECT_EQ(status(book.put_area({"more", stairs_.corners_map})), 409);
  EXPECT_EQ(status(book.put_place({{1, 1}, {}, "7"})), 204) << "there already";
}

TEST_F(NoteBookTest, ANewStartSetsAsideWhatWasDrawnOnTheOldMap) {
  auto book = start("20261126-1");
  EXPECT_TRUE(book->notes().notice.empty());
  EXPECT_EQ(status(book->put_area(stairs_)), 204);
  EXPECT_EQ(status(book->put_place({{1, 2},
                                    0.25,
                                    "K\xc3\xbc"
                                    "che"})),
            204);
  EXPECT_EQ(status(book->put_home({{1, 2}, {}, {}})), 204);
  const std::string saved = text("notes.json");
  const Notes before = book->notes();
  book.reset();

  book = start("20261126-2");
  EXPECT_TRUE(book->notes().is_empty());
  EXPECT_TRUE(told().forbidden_map.empty()) << "it holds no more";
  EXPECT_THAT(book->notes().notice, HasSubstr("notes-20261126-1.json"));
  EXPECT_EQ(text("notes-20261126-1.json"), saved);
  const Notes kept = notes_from(saved);
  EXPECT_EQ(kept.places, before.places);
  EXPECT_EQ(kept.home, before.home);
  EXPECT_EQ(kept.areas.at(0).corners_map, stairs_.corners_map);
  book.reset();

  book = start("20261126-3");
  EXPECT_THAT(book->notes().notice, HasSubstr("notes-20261126-1.json")) << "until somebody has read it";
  EXPECT_EQ(status(book->dismiss_notice()), 204);
  book.reset();
  EXPECT_TRUE(start("20261126-4")->notes().notice.empty());
}

TEST_F(NoteBookTest, KeepsTheNewestTen) {
  for (int map = 10; map < 23; ++map)
    EXPECT_EQ(status(start(std::to_string(map))->put_place({{0, 0}, {}, "p"})), 204);
  EXPECT_FALSE(fs::exists(folder_ / "notes-11.json"));
  for (int map = 12; map < 22; ++map)
    EXPECT_TRUE(fs::exists(folder_ / ("notes-" + std::to_string(map) + ".json"))) << map;
}

TEST_F(NoteBookTest, KeepsWhatItSetsAsideThoughTheClockWasWrong) {
  for (int map = 10; map < 23; ++map)
    EXPECT_EQ(status(start(std::to_string(map))->put_place({{0, 0}, {}, "p"})), 204);
  EXPECT_EQ(status(start("01")->put_place({{0, 0}, {}, "p"})), 204);
  EXPECT_THAT(start("23")->notes().notice, HasSubstr("notes-01.json"));
  EXPECT_TRUE(fs::exists(folder_ / "notes-01.json"));
}

TEST_F(NoteBookTest, LosesNothingWhenTwoMapsHaveOneId) {
  for (const char* name : {"a", "b", "c"}) EXPECT_EQ(status(start("7")->put_place({{0, 0}, {}, name})), 204);
  EXPECT_THAT(start("7")->notes().notice, HasSubstr("notes-7-3.json"));
  EXPECT_EQ(notes_from(text("notes-7.json")).places.at(0).name, "a");
  EXPECT_EQ(notes_from(text("notes-7-2.json")).places.at(0).name, "b");
  EXPECT_EQ(notes_from(text("notes-7-3.json")).places.at(0).name, "c");
}

TEST_F(NoteBookTest, SetsAsideWhatCannotBeReadAndGoesOn) {
  const std::string whole = [&] {
    auto book = start("1");
    EXPECT_FALSE(book->put_place({{0, 0}, {}, "p"}));
    EXPECT_FALSE(book->put_area(stairs_));
    return text("notes.json");
  }();
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string changed = whole;
    EXPECT_NE(changed.find(part), std::string::npos) << part;
    return changed.replace(changed.find(part), part.size(), other);
  };
  for (const std::string& damaged :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
        with("\"version\": 1", "\"version\": 2"), with("\"map_id\": \"1\"", "\"map_id\": \"../1\""),
        with("\"p\"", "\"a/p\""), with("\"x_m\": 0.0", "\"x_m\": 1e9"),
        with("\"x_m\": 0.0", "\"x_m\": \"0\""), std::string(2 << 20, ' ')}) {
    write("notes.json", damaged);
    const auto book = start("2");
    EXPECT_THAT(book->notes().notice, HasSubstr("notes.json.damaged"));
    EXPECT_EQ(text("notes.json.damaged"), damaged);
    EXPECT_TRUE(book->notes().is_empty());
    EXPECT_EQ(status(book->put_place({{0, 0}, {}, "p"})), 204);
    fs::remove(folder_ / "notes.json.damaged");
  }
}

TEST_F(NoteBookTest, WhatIsTruncatedAnywhereIsSetAside) {
  std::string whole;
  {
    const auto book = start("1");
    EXPECT_FALSE(book->put_area(stairs_));
    whole = text("notes.json");
  }
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    write("notes.json", whole.substr(0, length));
    EXPECT_THAT(start("2")->notes().notice, HasSubstr("notes.json.damaged")) << length;
    EXPECT_EQ(text("notes.json.damaged"), whole.substr(0, length));
    fs::remove(folder_ / "notes.json.damaged");
  }
}

TEST_F(NoteBookTest, AClockThatIsSetBackMakesNoOlderMapOlder) {
  std::vector<std::string> kept;
  for (int run = 0; run < 14; ++run) {
    const auto book = start(run % 3 == 0 ? "20261126-10000" + std::to_string(run / 3) : "19700101-000010");
    EXPECT_EQ(status(book->put_place({{0, 0}, {}, "run " + std::to_string(run)})), 204);
  }
  std::vector<fs::path> files(fs::directory_iterator(folder_), {});
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    if (const std::string name = file.filename(); name.starts_with("notes-"))
      kept.push_back(notes_from(text(name)).places.at(0).name);
  std::vector<std::string> newest;
  for (int run = 3; run < 13; ++run) newest.push_back("run " + std::to_string(run));
  EXPECT_EQ(kept, newest) << "in this order";
}

TEST_F(NoteBookTest, WhatCannotBeSavedIsKeptInMemoryAndSaidUntilItCan) {
  const auto book = start("1");
  EXPECT_EQ(status(book->put_place({{0, 0}, {}, "p"})), 204);
  const std::string saved = text("notes.json");
  {
    const test::FileSizeLimit full(100);
    EXPECT_EQ(status(book->put_area(stairs_)), 204);
    EXPECT_EQ(told().forbidden_map.size(), 1U) << "the robot keeps out of there";
    EXPECT_THAT(book->trouble(), HasSubstr("notes.json"));
    EXPECT_THAT(book->notes().notice, HasSubstr("Nothing is saved until this is mended: cannot write to "));
    EXPECT_EQ(text("notes.json"), saved);
    EXPECT_EQ(status(book->dismiss_notice()), 204);
    EXPECT_EQ(book->notes().notice, "") << "it was read";
    const auto version = robot_.get().version;
    book->tend("");
    EXPECT_EQ(robot_.get().version, version) << "no news";
  }
  book->tend("");
  EXPECT_EQ(book->trouble(), "");
  EXPECT_EQ(notes_from(text("notes.json")).areas.size(), 1U);
  const test::FileSizeLimit full(100);
  EXPECT_EQ(status(book->put_home({{1, 2}, {}, {}})), 204);
  EXPECT_NE(book->notes().notice, "") << "it is new again";
}

TEST_F(NoteBookTest, DoesWithoutAFolder) {
  NoteBook book(robot_, "1", "/proc/nowhere");
  EXPECT_THAT(book.notes().notice, HasSubstr("/proc/nowhere"));
  EXPECT_EQ(status(book.put_area(stairs_)), 204);
  EXPECT_EQ(book.notes().areas.size(), 1U);
}

TEST_F(NoteBookTest, TellsOfTroublesOfOthersAndOfWhatTheyFound) {
  const auto book = start("1");
  const auto version = robot_.get().version;
  book->tend("the disk is full");
  EXPECT_NE(robot_.get().version, version) << "people look again";
  EXPECT_THAT(book->notes().notice, HasSubstr("the disk is full"));
  book->tend("");
  EXPECT_EQ(book->notes().notice, "");
  book->add_notice("A file was broken.");
  EXPECT_EQ(book->notes().notice, "A file was broken.");
}

}  // namespace
}  // namespace dynslam
