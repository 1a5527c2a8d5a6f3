#include "coordinator/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/build_info.hpp"
#include "base/endpoint.hpp"

namespace abut {
namespace {

constexpr double longest_probe = 60.0;  // [s]
constexpr int most_parts = 64;          // as many as processes of a run

/// Verbs that are programs of their own beside this one.
const std::array<std::pair<std::string, std::string>, 5> tools{{
    {"report", "make a page of a run: tables, figures, moving bodies"},
    {"monitor", "show a run in a browser while it goes on"},
    {"film", "draw a run's bodies as they move: a GIF or MP4"},
    {"picture", "draw a run's bodies at one time: a PNG"},
    {"study", "run a scene with many settings: cost against accuracy"},
}};

constexpr std::array<std::string_view, 10> own_verbs{
    "run",    "resume",    "check",       "split", "init",
    "keygen", "reference", "conformance", "slurm", "kubernetes"};

const CLI::Validator endpoint_word(
    [](const std::string& endpoint) {
      const std::string wrong(wrong_endpoint(endpoint));
      return wrong.empty() ? wrong : endpoint + " must " + wrong;
    },
    "", "endpoint_word");

/// An empty path is most often a variable of a script that was never set.
const CLI::Validator named_folder(
    [](const std::string& text) {
      return text.empty() ? std::string("is empty: name a folder, or leave it out") : "";
    },
    "", "named_folder");

void add_overrides(CLI::App& verb, std::vector<std::string>& overrides) {
  verb.add_option("--set", overrides,
                  "use this value in place of the scene's, null for none; repeatable")
      ->type_name("key.path=value")
      ->allow_extra_args(false);
}

void add_scene(CLI::App& verb, std::string& scene, std::vector<std::string>& overrides) {
  verb.add_option("scene", scene, "scene file")->required()->type_name("SCENE");
  add_overrides(verb, overrides);
}

void add_trace(CLI::App& verb, bool& trace) {
  verb.add_flag("--trace", trace, "write to DIR/trace.json what the time goes into, for Perfetto");
}

void add_insecure(CLI::App& verb, bool& insecure) {
  verb.add_flag("--insecure", insecure,
                "wait for bodies of other machines without keys, on a network that you trust");
}

void add_grace(CLI::App& verb, unsigned& grace) {
  verb.add_option("--grace", grace,
                  "time that the window under way has where a signal ends the run, for a state to "
                  "go on from; default 10, and a second signal ends it at once")
      ->type_name("SECONDS")
      ->check(CLI::Range(1, 86'400).description(""));
}

/// Absent, unless the option that makes it is there.
struct AwaitWords {
  Awaited words;
  std::optional<Awaited> given() const {
    return words.endpoint.empty() ? std::nullopt : std::optional(words);
  }
};

void add_await(CLI::App& verb, AwaitWords& await) {
  CLI::Option& endpoint =
      *verb.add_option("--await", await.words.endpoint,
                       "start no process: wait at this address for those of all bodies, which "
                       "somebody else starts, as abut slurm does")
           ->type_name("ENDPOINT")
           ->check(endpoint_word)
           ->excludes(verb.get_option("--local"));
  verb.add_option("--keys", await.words.keys,
                  "folder with the keys of coordinator and processes (abut keygen)")
      ->type_name("DIR")
      ->check(named_folder)
      ->needs(&endpoint);
  verb.add_option("--patience", await.words.patience, "time for all of them to come; default 60")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.1, 604'800.0).description(""))
      ->needs(&endpoint);
}

CLI::App& add_run(CLI::App& app, RunCommand& run, AwaitWords& await) {
  CLI::App& verb = *app.add_subcommand("run", "run a scene and evaluate its expectations");
  add_scene(verb, run.scene, run.overrides);
  verb.add_option("--out", run.out, "run directory; default runs/<scene name>")
      ->type_name("DIR")
      ->check(named_folder);
  verb.add_flag("--local", run.local, "all bodies in this process");
  verb.add_flag("--quiet", run.quiet, "print errors and failed expectations only");
  verb.add_flag("--force", run.force, "replace the run that DIR holds");
  add_await(verb, await);
  add_insecure(verb, run.insecure);
  add_trace(verb, run.trace);
  add_grace(verb, run.grace);
  return verb;
}

CLI::App& add_resume(CLI::App& app, ResumeCommand& resume, AwaitWords& await) {
  CLI::App& verb = *app.add_subcommand("resume", "go on with a run from its latest checkpoint");
  verb.add_option("directory", resume.directory, "run directory")
      ->required()
      ->type_name("DIR")
      ->check(named_folder);
  verb.add_option("--scene", resume.scene, "the scene as it is now; default as the run has it")
      ->type_name("SCENE");
  verb.add_option("--end", resume.end, "go on up to this time of the scene")->type_name("TIME");
  add_overrides(verb, resume.overrides);
  verb.add_flag("--local", resume.local, "all bodies in this process");
  verb.add_flag("--quiet", resume.quiet, "print errors and failed expectations only");
  add_await(verb, await);
  add_insecure(verb, resume.insecure);
  add_trace(verb, resume.trace);
  add_grace(verb, resume.grace);
  return verb;
}

CLI::App& add_check(CLI::App& app, CheckCommand& check) {
  CLI::App& verb =
      *app.add_subcommand("check", "say whether a scene is valid, and what its run will be");
  add_scene(verb, check.scene, check.overrides);
  verb.add_flag("--verbose", check.verbose, "tell as well what the scene leaves unused");
  verb.add_option("--probe", check.probe,
                  "try the run for so long, writing nothing, to predict its time and memory; "
                  "default 2, 0 for not at all")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, longest_probe).description(""));
  return verb;
}

CLI::App& add_split(CLI::App& app, SplitCommand& split) {
  CLI::App& verb = *app.add_subcommand("split", "write a scene with one body as several tied ones");
  add_scene(verb, split.scene, split.overrides);
  verb.add_option("--bodies", split.bodies, "number of bodies that it becomes, 2 to 64")
      ->required()
      ->type_name("N")
      ->check(CLI::Range(2, most_parts).description(""));
  verb.add_option("--body", split.body, "body to divide; default the only one that can be")
      ->type_name("NAME");
  verb.add_option("--out", split.out, "folder of the new scene; default <scene name>_split_N")
      ->type_name("DIR")
      ->check(named_folder);
  verb.add_flag("--force", split.force, "replace the files that DIR holds");
  return verb;
}

CLI::App& add_init(CLI::App& app, InitCommand& init) {
  CLI::App& verb = *app.add_subcommand("init", "write a commented scene that runs, to begin with");
  verb.add_option("name", init.name, "the scene's file, with or without .yaml")
      ->required()
      ->type_name("NAME");
  verb.add_option("--from", init.from, "what it is of; default bars")
      ->type_name("{bars,contact,friction,joined,study,mesh,gmsh}");
  verb.add_option("mesh", init.meshes, "mesh files of --from mesh (.msh, .inp), a body each")
      ->type_name("MESH");
  verb.add_flag("--force", init.force, "replace the files that are there");
  return verb;
}

CLI::App& add_keygen(CLI::App& app, KeygenCommand& keygen) {
  CLI::App& verb = *app.add_subcommand(
      "keygen", "make keys of a coordinator and of bodies that connect (network.keys)");
  verb.add_option("directory", keygen.directory, "folder of the keys")
      ->required()
      ->type_name("DIR")
      ->check(named_folder);
  verb.add_option("body", keygen.bodies,
                  "name of a body, or of a process of several, that gets a pair of its own")
      ->type_name("NAME");
  return verb;
}

CLI::App& add_reference(CLI::App& app, ReferenceCommand& reference) {
  CLI::App& verb =
      *app.add_subcommand("reference", "print the keys of a scene file, all of them as Markdown");
  CLI::Option& key = *verb.add_option("key", reference.key,
                                      "one of them and what is below it, as bodies.b.material")
                          ->type_name("KEY");
  CLI::Option& schema =
      *verb.add_flag("--json-schema", reference.json_schema,
                     "print a JSON Schema, with which editors complete and check scene files");
  verb.add_flag("--keys", reference.keys, "print key paths alone, a line each")
      ->excludes(&key)
      ->excludes(&schema);
  schema.excludes(&key);
  return verb;
}

CLI::App& add_conformance(CLI::App& app, ConformanceCommand& conformance) {
  CLI::App& verb = *app.add_subcommand(
      "conformance", "say which clauses of the contract a solver keeps, and how it breaks others");
  verb.add_option("what", conformance.what,
                  "scene (.yaml), whose bodies are tried; or a program of a body, or the endpoint "
                  "where one connects")
      ->required()
      ->type_name("SCENE|PROGRAM|ENDPOINT");
  verb.add_option("--keys", conformance.keys,
                  "keys of the body of a program or endpoint, as below model.external; default {}")
      ->type_name("YAML");
  verb.add_option("--body", conformance.body, "its name; default body")->type_name("NAME");
  verb.add_option("--window", conformance.window,
                  "length of a window of a body without a step; default 0.001")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber.description(""));
  verb.add_option("--deadline", conformance.deadline,
                  "longest time without a reply or a sign of progress; default 10")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber.description(""));
  verb.add_option("--only", conformance.only, "hold it to these clauses alone")
      ->delimiter(',')
      ->type_name("CLAUSE,...")
      ->take_all();
  add_overrides(verb, conformance.overrides);
  return verb;
}

CLI::App& add_slurm(CLI::App& app, SlurmCommand& slurm) {
  CLI::App& verb = *app.add_subcommand(
      "slurm", "write a job for sbatch: a coordinator, and a step for each process of bodies");
  add_scene(verb, slurm.scene, slurm.overrides);
  verb.add_option("-o,--output", slurm.script, "file of the script; default standard output")
      ->type_name("FILE");
  verb.add_option("--out", slurm.directory, "run directory; default runs/<scene name>")
      ->type_name("DIR")
      ->check(named_folder);
  verb.add_option("--sbatch", slurm.options,
                  "an option of sbatch that the script holds, as --sbatch=--time=2:00:00; "
                  "repeatable")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  verb.add_flag("--force", slurm.force, "replace the file that is there");
  return verb;
}

CLI::App& add_kubernetes(CLI::App& app, KubernetesCommand& kubernetes) {
  CLI::App& verb = *app.add_subcommand(
      "kubernetes", "write a Kustomize base: jobs of a coordinator and of each process of bodies");
  add_scene(verb, kubernetes.scene, kubernetes.overrides);
  verb.add_option("-o,--out", kubernetes.out, "its folder; default <scene name>_kubernetes")
      ->type_name("DIR")
      ->check(named_folder);
  verb.add_option("--image", kubernetes.image, "image with abut; default abut:latest")
      ->type_name("IMAGE");
  verb.add_option("--claim", kubernetes.claim,
                  "claim of a volume that keeps the run; default none: it goes with the pod")
      ->type_name("NAME");
  verb.add_flag("--force", kubernetes.force, "replace the files that DIR holds");
  return verb;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  const std::string_view verb = argc > 1 ? argv[1] : "";
  const bool is_own = std::find(own_verbs.begin(), own_verbs.end(), verb) != own_verbs.end();
  if (!verb.empty() && !verb.starts_with('-') && !is_own)
    return ExternalCommand{std::string(verb), {argv + 2, argv + argc}};

  CLI::App app("abut: collision of solids that are solved by separate programs", "abut");
  app.set_version_flag("--version", version_text("abut"),
                       "Print version, commit and options of the build, and exit");
  app.require_subcommand(1);

  RunCommand run;
  AwaitWords await_of_run, await_of_resume;
  const CLI::App& run_verb = add_run(app, run, await_of_run);

  ResumeCommand resume;
  const CLI::App& resume_verb = add_resume(app, resume, await_of_resume);

  CheckCommand check;
  const CLI::App& check_verb = add_check(app, check);

  SplitCommand split;
  const CLI::App& split_verb = add_split(app, split);

  InitCommand init;
  const CLI::App& init_verb = add_init(app, init);

  KeygenCommand keygen;
  const CLI::App& keygen_verb = add_keygen(app, keygen);

  ReferenceCommand reference;
  const CLI::App& reference_verb = add_reference(app, reference);

  ConformanceCommand conformance;
  const CLI::App& conformance_verb = add_conformance(app, conformance);

  SlurmCommand slurm;
  const CLI::App& slurm_verb = add_slurm(app, slurm);
  KubernetesCommand kubernetes;
  const CLI::App& kubernetes_verb = add_kubernetes(app, kubernetes);

  // For the list alone: their command lines are read by programs of their own.
  for (const auto& [name, purpose] : tools) app.add_subcommand(name, purpose);
  // Last: verbs take over the footer that is there when they are added.
  app.footer(
      "abut VERB --help tells what a verb takes. Any other verb V runs the program abut-V.\n"
      "Exit codes: 0 when the scene's expectations hold, 1 when they do not or the numbers failed, "
      "2 when the input is refused, 3 when something outside failed.");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = app.exit(error, out, err);
    return code == 0 ? PrintCommand{out.str(), 0} : PrintCommand{"error: " + err.str(), 2};
  }
  run.awaited = await_of_run.given();
  resume.awaited = await_of_resume.given();
  if (run_verb.parsed()) return run;
  if (resume_verb.parsed()) return resume;
  if (check_verb.parsed()) return check;
  if (split_verb.parsed()) return split;
  if (init_verb.parsed()) return init;
  if (keygen_verb.parsed()) return keygen;
  if (reference_verb.parsed()) return reference;
  if (conformance_verb.parsed()) return conformance;
  if (slurm_verb.parsed()) return slurm;
  if (kubernetes_verb.parsed()) return kubernetes;
  return PrintCommand{app.help(), 2};
}

}  // namespace abut
