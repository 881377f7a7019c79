// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/rplidar/messages.h"

namespace dynslam::rplidar {
namespace {

using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

TEST(RplidarRequests, AreTheBytesOfTheManual) {
  EXPECT_THAT(request(Command::kStop), ElementsAre(0xA5, 0x25));
  EXPECT_THAT(request(Command::kGetHealth), ElementsAre(0xA5, 0x52));
  EXPECT_THAT(conf_request(ConfItem::kModeCount), ElementsAre(0xA5, 0x84, 4, 0x70, 0, 0, 0, 0x55));
  EXPECT_THAT(conf_request(ConfItem::kTypicalMode), ElementsAre(0xA5, 0x84, 4, 0x7C, 0, 0, 0, 0x59));
  EXPECT_THAT(conf_request(ConfItem::kSampleTime, 3), ElementsAre(0xA5, 0x84, 6, 0x71, 0, 0, 0, 3, 0, 0x55));
  EXPECT_THAT(conf_request(ConfItem::kMaxRange, 3), ElementsAre(0xA5, 0x84, 6, 0x74, 0, 0, 0, 3, 0, 0x50));
  EXPECT_THAT(conf_request(ConfItem::kAnswerType, 3), ElementsAre(0xA5, 0x84, 6, 0x75, 0, 0, 0, 3, 0, 0x51));
  EXPECT_THAT(conf_request(ConfItem::kModeName, 3), ElementsAre(0xA5, 0x84, 6, 0x7F, 0, 0, 0, 3, 0, 0x5B));
  EXPECT_THAT(express_request(3), ElementsAre(0xA5, 0x82, 5, 3, 0, 0, 0, 0, 0x21));
  EXPECT_THAT(express_request(4), ElementsAre(0xA5, 0x82, 5, 4, 0, 0, 0, 0, 0x26));
  EXPECT_THAT(motor_request(Command::kMotorPwm, 660), ElementsAre(0xA5, 0xF0, 2, 0x94, 2, 0xC1));
  EXPECT_THAT(motor_request(Command::kMotorPwm, 0), ElementsAre(0xA5, 0xF0, 2, 0, 0, 0x57));
  EXPECT_THAT(motor_request(Command::kMotorRpm, 600), ElementsAre(0xA5, 0xA8, 2, 0x58, 2, 0x55));
  EXPECT_THAT(accessory_request(), ElementsAre(0xA5, 0xFF, 4, 0, 0, 0, 0, 0x5E));
}

TEST(RplidarAnswers, BeginWithSizeAndType) {
  const auto health = parse_head(Bytes{0xA5, 0x5A, 3, 0, 0, 0, 6});
  ASSERT_TRUE(health);
  EXPECT_EQ(health->size, 3U);
  EXPECT_FALSE(health->repeated);
  EXPECT_EQ(health->type, AnswerType::kHealth);
  const auto ultra = parse_head(Bytes{0xA5, 0x5A, 0x84, 0, 0, 0x40, 0x84});
  ASSERT_TRUE(ultra);
  EXPECT_EQ(ultra->size, 132U);
  EXPECT_TRUE(ultra->repeated);
  EXPECT_EQ(ultra->type, AnswerType::kUltra);
  EXPECT_FALSE(parse_head(Bytes{0xA5, 0x5A, 3, 0, 0, 0}));
  EXPECT_FALSE(parse_head(Bytes{0xA5, 0x5B, 3, 0, 0, 0, 6}));
}

TEST(RplidarAnswers, TellModelFirmwareAndSerialNumber) {
  Bytes payload{0x31, 0x1D, 0x01, 7};
  for (int i = 0; i < 16; ++i) payload.push_back(static_cast<std::uint8_t>(0xA0 + i));
  const auto info = parse_info(payload);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->model_name(), "A3M1");
  EXPECT_EQ(info->firmware(), "1.29");
  EXPECT_EQ(info->hardware, 7);
  EXPECT_EQ(info->serial, "A0A1A2A3A4A5A6A7A8A9AAABACADAEAF");
  EXPECT_TRUE(info->tells_modes());
  payload.pop_back();
  EXPECT_FALSE(parse_info(payload));
}

TEST(RplidarAnswers, KnowOfWhichSeriesAModelIs) {
  const auto name = [](int model) {
    return DeviceInfo{static_cast<std::uint8_t>(model), 1, 0, 0, {}}.model_name();
  };
  EXPECT_EQ(name(0x18), "A1M8");
  EXPECT_EQ(name(0x2C), "A2M12");
  EXPECT_EQ(name(0x41), "C1M1");
  EXPECT_EQ(name(0x61), "S1M1");
  EXPECT_EQ(name(82), "C2M2");
  EXPECT_EQ(name(0x00), "model 0");
}

TEST(RplidarAnswers, OldFirmwareOfTheASeriesDoesNotTellItsModes) {
  EXPECT_FALSE((DeviceInfo{0x18, 1, 23, 5, {}}.tells_modes()));
  EXPECT_TRUE((DeviceInfo{0x18, 1, 24, 5, {}}.tells_modes()));
  EXPECT_TRUE((DeviceInfo{0x41, 1, 1, 18, {}}.tells_modes()));
}

TEST(RplidarAnswers, PutHealthInWords) {
  EXPECT_EQ(in_words(*parse_health(Bytes{0, 0, 0})), "fine");
  EXPECT_EQ(in_words(*parse_health(Bytes{1, 1, 0})), "warns that it may soon fail (code 0001)");
  EXPECT_EQ(in_words(*parse_health(Bytes{2, 2, 0x80})), "stopped to protect itself (code 8002)");
  EXPECT_FALSE(parse_health(Bytes{3, 0, 0})) << "no such state";
  EXPECT_FALSE(parse_health(Bytes{0, 0}));
}

TEST(RplidarAnswers, TellModes) {
  const Bytes typical{0x7C, 0, 0, 0, 3, 0}, time{0x71, 0, 0, 0, 0xE6, 0x3E, 0, 0};
  EXPECT_EQ(parse_count(*parse_conf(typical, ConfItem::kTypicalMode)), 3);
  EXPECT_NEAR(*parse_sample_us(*parse_conf(time, ConfItem::kSampleTime)), 62.9, 0.01);
  EXPECT_FALSE(parse_conf(time, ConfItem::kMaxRange)) << "an answer to another question";
  EXPECT_EQ(parse_max_range_m(Bytes{0, 0x19, 0, 0}), 25.0);
  EXPECT_EQ(parse_answer_type(Bytes{0x84}), AnswerType::kUltra);
  EXPECT_EQ(parse_name(Bytes{'B', 'o', 'o', 's', 't', 0, 'x'}), "Boost");
}

TEST(RplidarAnswers, ThatCannotBeTrueAreNotBelieved) {
  EXPECT_FALSE(parse_sample_us(Bytes{0, 0, 0, 0}));
  EXPECT_FALSE(parse_sample_us(Bytes{0, 0, 0, 0x80}));
  EXPECT_FALSE(parse_sample_us(Bytes{0xE6, 0x3E, 0}));
  EXPECT_FALSE(parse_max_range_m(Bytes{0, 0, 0, 1}));
  EXPECT_FALSE(parse_answer_type(Bytes{0x99}));
  EXPECT_FALSE(parse_answer_type({}));
  EXPECT_FALSE(parse_name(Bytes{7, 8, 0}));
  EXPECT_FALSE(parse_name({}));
  EXPECT_FALSE(parse_count(Bytes{0xFF, 0xFF}));
}

TEST(RplidarModes, AreChosenByNameOrAsTheMakerSaysOrBySpeed) {
  const std::vector<ScanMode> modes{{0, "Standard", 252, 25, AnswerType::kStandard},
                                    {2, "Boost", 63, 25, AnswerType::kUltra},
                                    {4, "Stability", 100, 25, AnswerType::kUltra}};
  EXPECT_EQ(choose_mode(modes, "stability", 2)->id, 4);
  EXPECT_EQ(choose_mode(modes, "auto", 4)->id, 4);
  EXPECT_EQ(choose_mode(modes, "auto", 9)->id, 2) << "the typical one cannot be decoded";
  EXPECT_EQ(choose_mode(modes, "auto", std::nullopt)->id, 2);
  EXPECT_FALSE(choose_mode(modes, "Sensitivity", 2));
  EXPECT_FALSE(choose_mode({}, "auto", 2));
}

TEST(RplidarModes, OfAnOldLidarAreTwo) {
  const auto modes = legacy_modes(Bytes{0xDC, 1, 0xEE, 0});
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_EQ(modes[0].sample_us, 476.0);
  EXPECT_EQ(modes[1].sample_us, 238.0);
  EXPECT_EQ(choose_mode(modes, "auto", std::nullopt)->answer, AnswerType::kExpress);
  EXPECT_EQ(legacy_modes({})[0].sample_us, 476.0);
  EXPECT_EQ(legacy_modes(Bytes{0, 0, 0, 0})[0].sample_us, 476.0) << "nonsense";
}

}  // namespace
}  // namespace dynslam::rplidar
