#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sample_survey.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

class SeabedSkyEvalTest : public testing::Test {
 protected:
  SeabedSkyEvalTest() : survey_(folder_) {
    survey_.writeTruth();
    survey_.writeMap(0);
  }

  /// Runs the program; returns its exit code. What it printed is in `text_`.
  int run(const std::string& arguments) {
    const std::string log = folder_.path("log.txt");
    const std::string command = std::string(S2S_BIN_DIR) + "/seabed-sky-eval " + arguments + " > '" + log + "' 2>&1";
    const int status = std::system(command.c_str());
    std::ifstream in(log);
    text_.assign(std::istreambuf_iterator<char>(in), {});
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  nlohmann::json json(const std::string& name) const {
    std::ifstream in(folder_.path(name));
    return nlohmann::json::parse(in);
  }

  ScratchFolder folder_;
  SampleSurvey survey_;
  std::string text_;
};

constexpr const char* kSurveyed = "id,x,y,z,sigma\n1,0,0,1,0.01\n2,20,0,1,0.01\n3,20,10,1,0.01\n4,0,10,1,0.01\n";

}  // namespace

TEST_F(SeabedSkyEvalTest, Truth_PrintsATableAndWritesJson) {
  ASSERT_EQ(run("truth " + survey_.out() + " " + survey_.truth() + " --json " + folder_.path("r.json")), 0) << text_;
  EXPECT_NE(text_.find("ATE rmse [m]"), std::string::npos) << text_;
  EXPECT_LT(json("r.json").at("trajectory").at("ate_m").at("rmse").get<double>(), 1e-7);
  EXPECT_LT(json("r.json").at("seabed").at("max_m").get<double>(), 1e-4);
}

TEST_F(SeabedSkyEvalTest, Control_PrintsATableAndWritesJson) {
  const std::string points = folder_.write("points.csv", kSurveyed);
  const std::string picks = folder_.write("picks.csv", "id,x,y,z\n1,0,0,1\n2,20,0,1\n3,20,10,1\n4,0,10,1\n");
  ASSERT_EQ(run("control " + survey_.out() + " --points " + points + " --picks " + picks + " --json " +
                folder_.path("c.json")),
            0)
      << text_;
  EXPECT_LT(json("c.json").at("error_m").at("mean").get<double>(), 1e-12);
  EXPECT_NE(text_.find("leave-one-out"), std::string::npos);
}

TEST_F(SeabedSkyEvalTest, Wall_TakesNegativeCoordinates) {
  ASSERT_EQ(
      run("wall " + survey_.out() + " --from -15,20 --to 15,20 --half-width 0.5 --layers line_horizontal --truth " +
          survey_.truth() + " --json " + folder_.path("w.json")),
      0)
      << text_;
  EXPECT_NEAR(json("w.json").at("width_difference_m").get<double>(), 0, 1e-3);
  EXPECT_NEAR(json("w.json").at("cosine_similarity").get<double>(), 1, 1e-3);
}

TEST_F(SeabedSkyEvalTest, WrongUsage_ExitsWithTwo) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("fly"), 2);
  EXPECT_EQ(run("truth " + survey_.out()), 2);
  EXPECT_EQ(run("wall " + survey_.out() + " --from 1,2 --to 3,4 --half-width -1"), 2);
  EXPECT_EQ(run("wall " + survey_.out() + " --from 1 --to 3,4 --half-width 1"), 2);
  EXPECT_EQ(run("truth a b --align-map sideways"), 2);
  EXPECT_NE(text_.find("--help"), std::string::npos);
}

TEST_F(SeabedSkyEvalTest, UnusableInput_ExitsWithThreeAndSaysWhatToDo) {
  const std::string points = folder_.write("points.csv", kSurveyed);
  const std::string two = folder_.write("two.csv", "id,x,y,z\n1,0,0,1\n2,20,0,1\n");
  const std::string line = folder_.write("line.csv", "id,x,y,z\n1,0,0,1\n2,10,0,1\n3,20,0,1\n");
  EXPECT_EQ(run("truth " + folder_.path("absent") + " " + survey_.truth()), 3);
  EXPECT_NE(text_.find("what to do"), std::string::npos) << text_;
  EXPECT_EQ(run("truth " + survey_.out() + " " + folder_.path("absent")), 3);
  EXPECT_EQ(run("control " + survey_.out() + " --points " + points + " --picks " + folder_.path("absent.csv")), 3);
  EXPECT_EQ(run("control " + survey_.out() + " --points " + points + " --picks " + two), 3);
  EXPECT_NE(text_.find("fewer than three"), std::string::npos) << text_;
  EXPECT_EQ(run("control " + survey_.out() + " --points " + points + " --picks " + line), 3);
  EXPECT_NE(text_.find("on one line"), std::string::npos) << text_;
  EXPECT_EQ(run("wall " + survey_.out() + " --from 900,0 --to 940,0 --half-width 1 --layers stereo"), 3);
}
