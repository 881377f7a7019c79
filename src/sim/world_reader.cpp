// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <type_traits>

#include "base/error.h"
#include "sim/builtin_worlds.h"
#include "sim/furniture.h"
#include "sim/toml_fields.h"
#include "sim/world.h"
#include "sim/world_check.h"

namespace dynslam {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 20;
constexpr std::size_t kMaxThings = 20000;
constexpr Limits kDegrees{-360.0, 360.0};
constexpr Limits kShare{0.0, 1.0};
constexpr Limits kHeight{0.0, 100.0};
const Vector2 kOrigin = Vector2::Zero();

std::string label(const std::string& kind, const std::optional<std::string>& name) {
  return name ? kind + " \"" + *name + '"' : kind;
}

std::string label(const std::string& kind, const toml::table& table) {
  return label(kind, table["name"].value<std::string>());
}

/// Reads the tables of one kind into `all` by `read(fields) -> thing`. What has gaps is left out, so that no
/// complaint follows about where it stands; but a wall stays, for the doors that sit in it.
template <class Thing, class Read>
void read_all(TomlFields& file, const std::string& kind, Problems& problems, std::vector<Thing>& all,
              Read&& read) {
  for (const toml::table* table : file.tables(kind)) {
    TomlFields fields(*table, label(kind, *table), problems);
    Thing thing = read(fields);
    fields.finish();
    if (!fields.has_gaps() || std::is_same_v<Thing, Wall>) all.push_back(std::move(thing));
  }
}

Wall read_wall(TomlFields& f) {
  Wall wall;
  wall.line = f.line();
  wall.points = f.points("points", 2);
  if (f.flag("closed") && !wall.points.empty()) wall.points.push_back(wall.points.front());
  wall.thickness_m = f.number("thickness_m", wall.thickness_m, {0.01, 2.0});
  wall.height_m = f.number("height_m", wall.height_m, {0.01, 100.0});
  wall.glass = f.flag("glass");
  wall.colour = f.colour("colour").value_or(wall.glass ? 0xa8c4cc : wall.colour);
  return wall;
}

Door read_door(TomlFields& f) {
  Door door;
  door.line = f.line();
  door.name = f.text("name").value_or("");
  door.hinge = f.needed("hinge", f.point("hinge"), kOrigin);
  door.latch = f.needed("latch", f.point("latch"), Vector2(1, 0));
  door.opens_rad = radians(f.number("opens_deg", 90.0, {-180.0, 180.0}));
  door.open = f.number("open", 1.0, kShare);
  for (const auto& row : f.rows("schedule", 2)) {
    if (row[0] < 0 || row[1] < 0 || row[1] > 1) f.fail("schedule must be of [seconds, 0 closed to 1 open]");
    if (!door.schedule.empty() && row[0] <= door.schedule.back().at_s) f.fail("schedule must go on in time");
    door.schedule.push_back({row[0], row[1]});
  }
  door.speed_radps = radians(f.number("speed_degps", 85.0, {1.0, 720.0}));
  door.height_m = f.number("height_m", door.height_m, {0.01, 100.0});
  door.colour = f.colour("colour").value_or(door.colour);
  return door;
}

Person read_person(TomlFields& f) {
  Person person;
  person.line = f.line();
  person.name = f.text("name").value_or("");
  person.route = f.points("route", 2);
  person.then = static_cast<RouteEnd>(f.word("then", {"back", "round", "stay"}).value_or(0));
  person.speed_mps = f.number("speed_mps", person.speed_mps, {0.01, 5.0});
  person.starts_at_s = f.number("starts_at_s", 0.0, kSeconds);
  person.colour = f.colour("colour").value_or(person.colour);
  for (const auto& row : f.rows("pauses", 2)) {
    const bool is_point =
        row[0] >= 0 && row[0] < static_cast<double>(person.route.size()) && row[0] == std::floor(row[0]);
    if (!is_point || row[1] < 0) f.fail("pauses must be of [point of the route from 0, seconds]");
    if (is_point) person.pauses.push_back({static_cast<std::size_t>(row[0]), row[1]});
  }
  return person;
}

FurnitureForm read_form(TomlFields& f) {
  FurnitureForm form;
  const auto& shapes = furniture_shapes();
  form.shape = shapes[f.needed("shape", f.word("shape", shapes), std::size_t{0})];
  form.size_m = f.size("size_m");
  form.radius_m = f.number("radius_m", kLength);
  form.low_m = f.number("low_m", kHeight);
  form.high_m = f.number("high_m", kHeight);
  form.colour = f.colour("colour");
  form.dark = f.number("dark", 0.0, kShare);
  form.glass = f.flag("glass");
  form.points = f.points("points", form.shape == "polygon" ? 3 : 0);
  return form;
}

void read_moves(TomlFields& f, Furniture& thing, Problems& problems) {
  for (const toml::table* table : f.tables("moves")) {
    TomlFields fields(*table, "a move of furniture", problems);
    FurnitureMove move;
    move.at_s = fields.needed("at_s", fields.number("at_s", kSeconds), 0.0);
    move.lasts_s = fields.number("lasts_s", move.lasts_s, {0.1, 1e6});
    const Vector2 to = fields.needed("to", fields.point("to"), kOrigin);
    move.to = {to.x(), to.y(), radians(fields.number("yaw_deg", degrees(thing.world_T_thing.yaw), kDegrees))};
    fields.finish();
    const bool overlaps =
        !thing.moves.empty() && move.at_s < thing.moves.back().at_s + thing.moves.back().lasts_s;
    if (overlaps) fields.fail("begins before the move before it has ended");
    thing.moves.push_back(move);
  }
}

void read_furniture(TomlFields& f, Problems& problems, std::vector<Furniture>& all) {
  Furniture thing;
  thing.line = f.line();
  const FurnitureForm form = read_form(f);
  thing.name = f.text("name").value_or(form.shape);
  const Vector2 at = f.needed("at", f.point("at"), kOrigin);
  thing.world_T_thing = {at.x(), at.y(), radians(f.number("yaw_deg", 0.0, kDegrees))};
  thing.parts = furniture_parts(form);
  for (const Part& part : thing.parts) {
    if (part.low_m >= part.high_m) return f.fail("is not high enough: its parts need a height above zero");
  }
  read_moves(f, thing, problems);
  int copies = 1;
  Vector2 step = kOrigin;
  if (const toml::table* table = f.table("copies")) {
    TomlFields fields(*table, "copies of furniture", problems);
    copies = static_cast<int>(fields.needed("count", fields.number("count", {1, 1000}), 1.0));
    step = fields.needed("step", fields.point("step"), kOrigin);
    fields.finish();
  }
  for (int i = 0; i < copies && !f.has_gaps() && all.size() < kMaxThings; ++i) {
    all.push_back(thing);
    all.back().world_T_thing.x += i * step.x();
    all.back().world_T_thing.y += i * step.y();
  }
}

Doorstep read_doorstep(TomlFields& f) {
  Doorstep step;
  step.line = f.line();
  step.from = f.needed("from", f.point("from"), kOrigin);
  step.to = f.needed("to", f.point("to"), Vector2(1, 0));
  if ((step.to - step.from).norm() < 0.01) f.fail("must be longer than a centimetre");
  step.depth_m = f.number("depth_m", step.depth_m, {0.005, 2.0});
  step.height_m = f.number("height_m", step.height_m, {0.001, 0.03});
  return step;
}

FloorPatch read_floor(TomlFields& f) {
  FloorPatch floor;
  floor.line = f.line();
  floor.outline = f.points("points", 3);
  floor.colour = f.colour("colour").value_or(floor.colour);
  floor.pattern =
      static_cast<FloorPattern>(f.word("pattern", {"plain", "planks", "tiles", "carpet"}).value_or(0));
  return floor;
}

ScheduledFault read_fault(TomlFields& f) {
  ScheduledFault fault;
  const std::vector<std::string> devices(kSimDeviceNames.begin(), kSimDeviceNames.end());
  const std::vector<std::string> kinds(kFaultNames.begin(), kFaultNames.end());
  fault.device = static_cast<SimDevice>(f.needed("device", f.word("device", devices), std::size_t{0}));
  fault.kind = static_cast<FaultKind>(f.needed("kind", f.word("kind", kinds), std::size_t{0}));
  fault.at_s = f.needed("at_s", f.number("at_s", kSeconds), 0.0);
  fault.until_s = f.number("until_s", std::numeric_limits<double>::max(), kSeconds);
  if (fault.until_s <= fault.at_s) f.fail("until_s must be after at_s");
  if (!can_have(fault.device, fault.kind)) f.fail("this device cannot fail in this way");
  return fault;
}

ScheduledKick read_kick(TomlFields& f) {
  ScheduledKick kick;
  kick.at_s = f.needed("at_s", f.number("at_s", kSeconds), 0.0);
  const Vector2 by = f.needed("by", f.point("by"), Vector2(Vector2::Zero()));
  kick.robot_T_new = {by.x(), by.y(), radians(f.number("yaw_deg", 0.0, kDegrees))};
  return kick;
}

void read_start(TomlFields& file, Problems& problems, World& world) {
  const toml::table* table = file.table("start");
  if (table == nullptr) return file.fail("start is missing: start = { at = [x, y], yaw_deg = 0 }");
  TomlFields fields(*table, "start", problems);
  const Vector2 at = fields.needed("at", fields.point("at"), kOrigin);
  world.world_T_start = {at.x(), at.y(), radians(fields.number("yaw_deg", 0.0, kDegrees))};
  if (!fields.has_gaps()) world.start_line = fields.line();
  fields.finish();
}

World read_world(const toml::table& table, Problems& problems) {
  World world;
  TomlFields file(table, "world", problems);
  world.name = file.text("name").value_or("");
  read_start(file, problems, world);
  world.tour = file.points("tour", 0);
  if (const toml::node* tour = table.get("tour"))
    world.tour_line = static_cast<int>(tour->source().begin.line);
  read_all(file, "wall", problems, world.walls, read_wall);
  read_all(file, "door", problems, world.doors, read_door);
  read_all(file, "person", problems, world.people, read_person);
  read_all(file, "doorstep", problems, world.doorsteps, read_doorstep);
  read_all(file, "floor", problems, world.floors, read_floor);
  read_all(file, "fault", problems, world.faults, read_fault);
  read_all(file, "kick", problems, world.kicks, read_kick);
  std::stable_sort(world.kicks.begin(), world.kicks.end(),
                   [](const ScheduledKick& a, const ScheduledKick& b) { return a.at_s < b.at_s; });
  for (const toml::table* one : file.tables("furniture")) {
    TomlFields fields(*one, label("furniture", *one), problems);
    read_furniture(fields, problems, world.furniture);
    fields.finish();
  }
  if (world.furniture.size() >= kMaxThings) file.fail("more than 20000 pieces of furniture");
  file.finish();
  return world;
}

std::string read_text(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    throw InputError("cannot read world " + path + ": " + why);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("is a directory");
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored)) {
    fail("is no regular file");
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(std::strerror(errno));
  std::string text(kMaxFileBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) fail(std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxFileBytes) fail("larger than 1 MiB");
  return text;
}

}  // namespace

World parse_world(std::string_view text, const std::string& place) {
  Problems problems(place);
  World world;
  try {
    world = read_world(toml::parse(text), problems);
  } catch (const toml::parse_error& error) {
    problems.add(static_cast<int>(error.source().begin.line), std::string(error.description()));
  }
  check_world(world, problems);
  if (!problems.empty()) problems.raise();
  return world;
}

World load_world(const std::string& name_or_path) {
  for (const BuiltinWorld& world : builtin_worlds()) {
    if (world.name == name_or_path) return parse_world(world.toml, name_or_path + ".toml");
  }
  std::error_code ignored;
  const bool looks_like_path = name_or_path.find_first_of("/.") != std::string::npos;
  if (!looks_like_path && !std::filesystem::exists(name_or_path, ignored)) {
    std::string names;
    for (const std::string& name : builtin_world_names()) names += (names.empty() ? "" : ", ") + name;
    throw InputError("no world \"" + name_or_path + "\": there are " + names + ", or give a file");
  }
  return parse_world(read_text(name_or_path), name_or_path);
}

std::vector<std::string> builtin_world_names() {
  std::vector<std::string> names;
  for (const BuiltinWorld& world : builtin_worlds()) names.emplace_back(world.name);
  return names;
}

}  // namespace dynslam
