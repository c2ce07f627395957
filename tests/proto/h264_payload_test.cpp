#include "proto/h264_payload.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::annex_b;
using test::from_hex;
using test::nal_unit;
using test::to_hex;

std::vector<ByteBuffer> payloads_of(const ByteBuffer& access_unit, std::size_t first, std::size_t rest) {
  H264Packetizer packetizer;
  std::vector<ByteBuffer> out;
  for (const auto& plan : packetizer.plan(access_unit, first, rest)) {
    out.emplace_back();
    packetizer.append(plan, out.back());
    EXPECT_EQ(out.back().size(), plan.size);
  }
  return out;
}

Result<ByteBuffer> join(const std::vector<ByteBuffer>& payloads) {
  ByteBuffer out;
  H264Depacketizer depacketizer;
  depacketizer.begin(out);
  for (const auto& payload : payloads) {
    const auto added = depacketizer.add(payload);
    if (added.has_error()) return added.error();
  }
  const auto ended = depacketizer.end();
  if (ended.has_error()) return ended.error();
  return out;
}

TEST(SplitAnnexB, FindsUnitsBehindShortAndLongStartCodes) {
  const ByteBuffer bytes = from_hex("ff 00000001 67aa 000001 68bb 0000 000001 65 000000");
  std::vector<ByteView> nals;
  split_annex_b(bytes, nals);
  ASSERT_EQ(nals.size(), 3U);
  EXPECT_EQ(to_hex(nals[0]), "67aa");
  EXPECT_EQ(to_hex(nals[1]), "68bb");
  EXPECT_EQ(to_hex(nals[2]), "65");
}

TEST(SplitAnnexB, GivesNothingForNothing) {
  std::vector<ByteView> nals;
  for (const char* bytes : {"", "00", "000001", "00000001", "000001000001", "6588"}) {
    split_annex_b(from_hex(bytes), nals);
    EXPECT_TRUE(nals.empty()) << bytes;
  }
}

TEST(Packetizer, ASmallUnitIsAPayloadItself) {
  const auto payloads = payloads_of(from_hex("00000001 41 010203"), 100, 100);
  ASSERT_EQ(payloads.size(), 1U);
  EXPECT_EQ(to_hex(payloads[0]), "41010203");
}

TEST(Packetizer, SmallUnitsShareAStapA) {
  const auto payloads = payloads_of(from_hex("00000001 6742 00000001 28ce 000001 4588"), 100, 100);
  ASSERT_EQ(payloads.size(), 1U);
  EXPECT_EQ(to_hex(payloads[0]),
            "78"
            "00026742"
            "000228ce"
            "00024588");
}

TEST(Packetizer, LargeUnitsBecomeFuA) {
  const auto payloads = payloads_of(
      from_hex("000001 65 0102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f2021"), 18, 16);
  ASSERT_EQ(payloads.size(), 3U);
  EXPECT_EQ(to_hex(payloads[0]),
            "7c85"
            "0102030405060708090a0b0c0d0e0f10");
  EXPECT_EQ(to_hex(payloads[1]),
            "7c05"
            "1112131415161718191a1b1c1d1e");
  EXPECT_EQ(to_hex(payloads[2]),
            "7c45"
            "1f2021");
}

TEST(Packetizer, NoPayloadExceedsItsLimitAndEverythingComesBack) {
  Random random(2);
  for (int round = 0; round < 400; ++round) {
    std::vector<ByteBuffer> nals;
    const std::size_t count = 1 + random.below(8);
    for (std::size_t i = 0; i < count; ++i) {
      const auto type = static_cast<unsigned>(1 + random.below(12));
      nals.push_back(nal_unit(type, 1 + random.below(random.below(2) == 0 ? 40 : 4000), random));
    }
    const ByteBuffer access_unit = annex_b(nals);
    const std::size_t rest = 16 + random.below(1300);
    const std::size_t first = 16 + random.below(rest - 15);
    const auto payloads = payloads_of(access_unit, first, rest);
    for (std::size_t i = 0; i < payloads.size(); ++i) ASSERT_LE(payloads[i].size(), i == 0 ? first : rest);
    ASSERT_EQ(join(payloads).value(), access_unit);
  }
}

TEST(Packetizer, UnitsAtTheLimitsEdgeAreWhole) {
  Random random(4);
  for (std::size_t size = 95; size <= 105; ++size) {
    const ByteBuffer access_unit = annex_b({nal_unit(1, size, random)});
    const auto payloads = payloads_of(access_unit, 100, 100);
    EXPECT_EQ(payloads.size(), size <= 100 ? 1U : 2U) << size;
    EXPECT_EQ(join(payloads).value(), access_unit);
  }
}

TEST(Packetizer, AnEmptyAccessUnitGivesNoPayload) { EXPECT_TRUE(payloads_of({}, 100, 100).empty()); }

TEST(Packetizer, AllocatesNothingOnceItsListsHaveGrown) {
  Random random(9);
  H264Packetizer packetizer;
  const ByteBuffer large = test::picture(true, 50'000, random);
  const ByteBuffer small = test::picture(false, 20'000, random);
  const auto* before = packetizer.plan(large, 1100, 1150).data();
  EXPECT_EQ(packetizer.plan(small, 1100, 1150).data(), before);
  EXPECT_EQ(packetizer.plan(large, 1100, 1150).data(), before);
}

TEST(Depacketizer, TellsIdrSlicesInEveryForm) {
  const auto has_idr = [](std::initializer_list<const char*> payloads) {
    ByteBuffer out;
    H264Depacketizer depacketizer;
    depacketizer.begin(out);
    for (const char* p : payloads) EXPECT_TRUE(depacketizer.add(from_hex(p)).has_value()) << p;
    EXPECT_TRUE(depacketizer.end().has_value());
    return depacketizer.has_idr();
  };
  EXPECT_TRUE(has_idr({"65 88"}));
  EXPECT_TRUE(has_idr({"78 0002 6742 0002 6588"}));
  EXPECT_TRUE(has_idr({"7c85 01", "7c45 02"}));
  EXPECT_FALSE(has_idr({"41 88"}));
  EXPECT_FALSE(has_idr({"7c81 01", "7c41 02"}));
}

TEST(Depacketizer, RefusesWhatIsBroken) {
  const auto fails = [](std::initializer_list<const char*> hex) {
    std::vector<ByteBuffer> payloads;
    for (const char* p : hex) payloads.push_back(from_hex(p));
    return join(payloads).has_error();
  };
  EXPECT_TRUE(fails({}));
  EXPECT_TRUE(fails({""}));
  EXPECT_TRUE(fails({"00"}));                  // type 0
  EXPECT_TRUE(fails({"79 00 00"}));            // STAP-B
  EXPECT_TRUE(fails({"7f"}));                  // reserved
  EXPECT_TRUE(fails({"78"}));                  // STAP-A of nothing
  EXPECT_TRUE(fails({"78 0000"}));             // of an empty unit
  EXPECT_TRUE(fails({"78 0003 6742"}));        // size beyond the end
  EXPECT_TRUE(fails({"78 0002 6742 00"}));     // half a size
  EXPECT_TRUE(fails({"78 0002 7800"}));        // a STAP-A inside
  EXPECT_TRUE(fails({"7c85"}));                // FU-A of nothing
  EXPECT_TRUE(fails({"7cc5 01"}));             // start and end at once
  EXPECT_TRUE(fails({"7c45 01"}));             // end without start
  EXPECT_TRUE(fails({"7c85 01"}));             // start without end
  EXPECT_TRUE(fails({"7c85 01", "7c85 02"}));  // start twice
  EXPECT_TRUE(fails({"7c85 01", "7c41 02"}));  // another type
  EXPECT_TRUE(fails({"7c85 01", "41 02"}));    // another unit between
  EXPECT_TRUE(fails({"7c9c 01", "7c5c 02"}));  // an FU-A inside
  EXPECT_FALSE(fails({"7c85 01", "7c05 02", "7c45 03"}));
}

TEST(Depacketizer, SurvivesEveryDamage) {
  Random random(6);
  const auto payloads = payloads_of(test::picture(true, 100, random), 60, 40);
  for (std::size_t i = 0; i < payloads.size(); ++i) {
    test::for_each_damage(payloads[i], [&](const ByteBuffer& damaged) {
      auto changed = payloads;
      changed[i] = damaged;
      static_cast<void>(join(changed));
    });
  }
}

}  // namespace
}  // namespace atlaswire::proto
