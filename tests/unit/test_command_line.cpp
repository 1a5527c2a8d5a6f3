// Goal: every way to call the program means what its help says. Oracle: the fields of the command.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/command_line.hpp"

namespace abut::test_command_line {
namespace {

Command parsed(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "abut");
  return parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

TEST(CommandLine, RunTakesItsOptionsInAnyOrder) {
  const RunCommand run = std::get<RunCommand>(
      parsed({"run", "--set", "time.window=1e-6", "--local", "a.yaml", "--out", "d", "--quiet",
              "--set", "bodies={a: [1, 2], b: -1}", "--force"}));
  EXPECT_EQ(run.scene, "a.yaml");
  EXPECT_EQ(run.out, "d");
  EXPECT_EQ(run.overrides,
            (std::vector<std::string>{"time.window=1e-6", "bodies={a: [1, 2], b: -1}"}));
  EXPECT_TRUE(run.local && run.quiet && run.force);
}

TEST(CommandLine, RunWithoutOptionsHasNone) {
  const RunCommand run = std::get<RunCommand>(parsed({"run", "a.yaml"}));
  EXPECT_TRUE(run.out.empty() && run.overrides.empty());
  EXPECT_FALSE(run.local || run.quiet || run.force);
}

TEST(CommandLine, NothingIsOpenToOtherMachinesUnlessSaid) {
  EXPECT_FALSE(std::get<RunCommand>(parsed({"run", "a.yaml"})).insecure);
  EXPECT_TRUE(std::get<RunCommand>(parsed({"run", "a.yaml", "--insecure"})).insecure);
  EXPECT_FALSE(std::get<ResumeCommand>(parsed({"resume", "d"})).insecure);
  EXPECT_TRUE(std::get<ResumeCommand>(parsed({"resume", "d", "--insecure"})).insecure);
}

TEST(CommandLine, ProcessesOfOthersAreAwaitedWhereAnAddressIsGiven) {
  EXPECT_FALSE(std::get<RunCommand>(parsed({"run", "a.yaml"})).awaited.has_value());
  const Awaited run =
      std::get<RunCommand>(parsed({"run", "a.yaml", "--await", "tcp://h:1", "--keys", "k"}))
          .awaited.value();
  EXPECT_EQ(run.endpoint, "tcp://h:1");
  EXPECT_EQ(run.keys, "k");
  EXPECT_EQ(run.patience, 60.0);
  const Awaited resume =
      std::get<ResumeCommand>(parsed({"resume", "d", "--await", "ipc:///s", "--patience", "5"}))
          .awaited.value();
  EXPECT_EQ(resume.endpoint, "ipc:///s");
  EXPECT_TRUE(resume.keys.empty());
  EXPECT_EQ(resume.patience, 5.0);
  for (const std::vector<const char*>& wrong :
       {std::vector<const char*>{"run", "a.yaml", "--keys", "k"},
        {"run", "a.yaml", "--patience", "5"},
        {"run", "a.yaml", "--await", "tcp://h:1", "--local"},
        {"run", "a.yaml", "--await", "tcp://h:1", "--patience", "0"}})
    EXPECT_EQ(std::get<PrintCommand>(parsed(wrong)).exit_code, 2);
}

TEST(CommandLine, JobsTakeTheirOptions) {
  const SlurmCommand slurm = std::get<SlurmCommand>(
      parsed({"slurm", "a.yaml", "-o", "job.sh", "--out", "d", "--sbatch=--time=1",
              "--sbatch=--account=x", "--set", "a=1", "--force"}));
  EXPECT_EQ(slurm.scene, "a.yaml");
  EXPECT_EQ(slurm.script, "job.sh");
  EXPECT_EQ(slurm.directory, "d");
  EXPECT_EQ(slurm.options, (std::vector<std::string>{"--time=1", "--account=x"}));
  EXPECT_EQ(slurm.overrides, std::vector<std::string>{"a=1"});
  EXPECT_TRUE(slurm.force);
  const KubernetesCommand kubernetes = std::get<KubernetesCommand>(
      parsed({"kubernetes", "a.yaml", "-o", "d", "--image", "i", "--claim", "c"}));
  EXPECT_EQ(kubernetes.out, "d");
  EXPECT_EQ(kubernetes.image, "i");
  EXPECT_EQ(kubernetes.claim, "c");
  EXPECT_EQ(std::get<KubernetesCommand>(parsed({"kubernetes", "a.yaml"})).image, "abut:latest");
}

TEST(CommandLine, KeygenTakesAFolderAndBodies) {
  const KeygenCommand keygen = std::get<KeygenCommand>(parsed({"keygen", "d", "left", "right"}));
  EXPECT_EQ(keygen.directory, "d");
  EXPECT_EQ(keygen.bodies, (std::vector<std::string>{"left", "right"}));
  EXPECT_TRUE(std::get<KeygenCommand>(parsed({"keygen", "d"})).bodies.empty());
}

TEST(CommandLine, CheckTakesASceneAndOverrides) {
  const CheckCommand check = std::get<CheckCommand>(parsed({"check", "a.yaml", "--set", "a=1"}));
  EXPECT_EQ(check.scene, "a.yaml");
  EXPECT_EQ(check.overrides, std::vector<std::string>{"a=1"});
}

TEST(CommandLine, SplitTakesANumberOfBodies) {
  const SplitCommand split = std::get<SplitCommand>(
      parsed({"split", "a.yaml", "--bodies", "4", "--body", "plate", "--out", "d", "--force"}));
  EXPECT_EQ(split.scene, "a.yaml");
  EXPECT_EQ(split.bodies, 4);
  EXPECT_EQ(split.body, "plate");
  EXPECT_EQ(split.out, "d");
  EXPECT_TRUE(split.force && split.overrides.empty());
}

TEST(CommandLine, InitTakesANameAKindAndMeshes) {
  const InitCommand bars = std::get<InitCommand>(parsed({"init", "mine"}));
  EXPECT_EQ(bars.name, "mine");
  EXPECT_EQ(bars.from, "bars");
  EXPECT_TRUE(bars.meshes.empty() && !bars.force);
  const InitCommand gmsh = std::get<InitCommand>(
      parsed({"init", "mine", "--from", "gmsh", "a.msh", "b.msh", "--force"}));
  EXPECT_EQ(gmsh.name, "mine");
  EXPECT_EQ(gmsh.from, "gmsh");
  EXPECT_EQ(gmsh.meshes, (std::vector<std::string>{"a.msh", "b.msh"}));
  EXPECT_TRUE(gmsh.force);
}

TEST(CommandLine, OtherVerbsKeepTheirArgumentsUntouched) {
  const ExternalCommand report =
      std::get<ExternalCommand>(parsed({"report", "dir", "--help", "--set"}));
  EXPECT_EQ(report.verb, "report");
  EXPECT_EQ(report.arguments, (std::vector<std::string>{"dir", "--help", "--set"}));
}

TEST(CommandLine, VersionAndHelpAreNoErrors) {
  const PrintCommand version = std::get<PrintCommand>(parsed({"--version"}));
  EXPECT_TRUE(version.text.starts_with("abut ")) << version.text;
  EXPECT_NE(version.text.find("\ncommit   "), std::string::npos) << version.text;
  EXPECT_EQ(version.exit_code, 0);
  const PrintCommand help = std::get<PrintCommand>(parsed({"run", "--help"}));
  EXPECT_NE(help.text.find("--force"), std::string::npos) << help.text;
  EXPECT_EQ(help.exit_code, 0);
}

TEST(CommandLine, HelpListsEveryVerb) {
  const std::string help = std::get<PrintCommand>(parsed({"--help"})).text;
  for (const char* verb : {"run", "check", "split", "reference", "report", "study"})
    EXPECT_NE(help.find(std::string("\n  ") + verb + ' '), std::string::npos) << verb << help;
}

TEST(CommandLine, WhatIsWrongEndsWithCodeTwo) {
  for (const std::vector<const char*>& arguments :
       std::vector<std::vector<const char*>>{{},
                                             {"run"},
                                             {"split", "a"},
                                             {"init"},
                                             {"init", "a", "--from"},
                                             {"split", "a", "--bodies", "1"},
                                             {"run", "a", "b"},
                                             {"run", "a", "--nonsense"},
                                             {"check", "a", "--out", "d"},
                                             {"run", "a", "--set"},
                                             {"--nonsense"},
                                             {"reference", "a", "b"},
                                             {"reference", "a", "--keys"},
                                             {"reference", "--json-schema", "--keys"}}) {
    const Command command = parsed(arguments);
    ASSERT_TRUE(std::holds_alternative<PrintCommand>(command));
    EXPECT_EQ(std::get<PrintCommand>(command).exit_code, 2);
    EXPECT_TRUE(std::get<PrintCommand>(command).text.starts_with("error: "));
  }
}

}  // namespace
}  // namespace abut::test_command_line
