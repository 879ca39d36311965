// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/cost/thread_limit.h"
#include "tests/accuracy/hair.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

CertificateOptions few(std::uint32_t storms) {
    CertificateOptions options;
    options.storms = storms;
    options.strands = 2;
    return options;
}

/// Explicit springs so stiff that a substep overshoots.
Groom explosive() {
    Groom groom = straightHair(4, 12);
    groom.simulation.strandModel = runtime::StrandModel::springs;
    groom.simulation.integrator = runtime::Integrator::explicitEuler;
    groom.simulation.lengthMethod = runtime::LengthMethod::springs;
    groom.simulation.springFrequency = 10000;
    groom.simulation.substeps = 1;
    return groom;
}

TEST(Certificate, RodsWithstandAllThatIsTried) {
    const auto certificate = certify(straightHair(6, 12), few(60));
    ASSERT_TRUE(certificate) << certificate.error().message();
    EXPECT_TRUE(certificate->failed.empty()) << inWords(*certificate);
    EXPECT_EQ(certificate->within, 60u);
    EXPECT_GE(certificate->calm, 55u);
    EXPECT_EQ(certificate->calmLate, 60u);
    EXPECT_NEAR(certificate->limits.step, 0.08, 1e-9);
    EXPECT_NEAR(certificate->limits.turn, 144, 1e-9);
    EXPECT_GE(certificate->limits.rootSpeed, 200);
    EXPECT_GE(certificate->limits.wind, 200);
}

TEST(Certificate, WhatExplodesAtRestHasNoLimitsAndSaysSo) {
    const auto certificate = certify(explosive(), few(20));
    ASSERT_TRUE(certificate) << certificate.error().message();
    EXPECT_FALSE(certificate->failed.empty());
    EXPECT_EQ(certificate->limits.step, 0);
    EXPECT_THAT(inWords(*certificate), HasSubstr("Does not withstand any tested storm"));
    EXPECT_THAT(inWords(*certificate), HasSubstr(certificate->failed.front().what));
}

TEST(Certificate, FailedStormsAreCutOffWhereThatCostsTheLeast) {
    const StormStrength all = boxWithout({});
    EXPECT_EQ(all.rootSpeed, 300);
    const std::vector<FailedStorm> failed{
        {0, {0.01, 200, 20, 3}, "a"},      // two thirds of the speed
        {1, {0.02, 100, 170, 290}, "b"},   // of the wind more than of the turn
        {2, {0.02, 250, 170, 295}, "c"}};  // outside by then
    const StormStrength box = boxWithout(failed);
    EXPECT_EQ(box.step, all.step);
    EXPECT_EQ(box.turn, all.turn);
    EXPECT_NEAR(box.rootSpeed, 200, 1e-9);
    EXPECT_LT(box.rootSpeed, 200);
    EXPECT_NEAR(box.wind, 290, 1e-9);
    const std::vector<FailedStorm> calm{{0, {0, 0, 0, 0}, "explodes at rest"}};
    EXPECT_EQ(boxWithout(calm).wind, 0);
    EXPECT_EQ(boxWithout(calm).step, 0);
}

TEST(Certificate, IsTheSameForAnyNumberOfThreads) {
    const Groom groom = explosive();
    std::vector<std::string> words;
    for (const std::size_t threads : {1u, 2u}) {
        const ThreadLimit limit(threads);
        words.push_back(inWords(*certify(groom, few(12))));
    }
    EXPECT_EQ(words[0], words[1]);
}

TEST(Certificate, PartsThatRanApartSayWhatOneRunSays) {
    const Groom groom = explosive();
    std::vector<StormTally> tallies;
    for (const std::uint32_t first : {7u, 0u}) {
        CertificateOptions part = few(first == 0 ? 7 : 5);
        part.first = first;
        tallies.push_back(*runStorms(groom, part));
    }
    const auto joined = certificateOf(tallies);
    ASSERT_TRUE(joined) << joined.error().message();
    const auto whole = certify(groom, few(12));
    EXPECT_EQ(inWords(*joined), inWords(*whole));
    ASSERT_EQ(joined->failed.size(), whole->failed.size());
    for (std::size_t i = 0; i < joined->failed.size(); ++i)
        EXPECT_EQ(joined->failed[i].number, whole->failed[i].number);

    EXPECT_THAT(certificateOf({tallies[0]}).error().message(), HasSubstr("storms 0 to 7 are in no tally"));
    tallies.push_back(tallies[0]);
    EXPECT_THAT(certificateOf(tallies).error().message(), HasSubstr("in two tallies"));
}

TEST(Certificate, NothingToCertifyAndCancellingAreErrors) {
    EXPECT_FALSE(certify(Groom{}, few(1)));
    CertificateOptions options = few(4);
    options.cancelled = [] { return true; };
    const auto certificate = certify(straightHair(2, 8), options);
    ASSERT_FALSE(certificate);
    EXPECT_THAT(certificate.error().message(), HasSubstr("cancelled"));
}

}  // namespace
}  // namespace hairloom::test
