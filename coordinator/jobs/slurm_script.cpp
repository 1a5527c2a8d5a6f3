#include "coordinator/jobs/slurm_script.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/shell_word.hpp"

namespace abut {

namespace {

constexpr int seconds_to_end =
    120;  // before the time limit, for the window under way and its state

/// What the script says after its options, up to the steps. Bash, for `wait` on what has ended.
constexpr const char* head = R"(
set -u
umask 077
programs={programs}
scene={scene}
out={out}
keys=$(mktemp -d "$PWD/abut-keys-XXXXXX") || exit 3  # of this job alone; nodes share $PWD
trap 'rm -rf "$keys"' EXIT
"${{programs}}abut" keygen "$keys" {names} > "$keys/made" || exit
port=$((10000 + SLURM_JOB_ID % 20000))
to="tcp://${{ABUT_HOST:-$(hostname)}}:$port"  # this node, as the others know it

# The coordinator: it goes on from what an earlier job has kept, or this one before it was requeued.
if [ -e "$out/checkpoint.abut" ] || [ -e "$out/checkpoint.before.abut" ]; then
  set -- resume "$out"
else
  set -- run "$scene" --out "$out"{overrides}
  [ "${{SLURM_RESTART_COUNT:-0}}" -gt 0 ] && set -- "$@" --force
fi
stopped=
"${{programs}}abut" "$@" --await "tcp://0.0.0.0:$port" --keys "$keys" --patience 600 &
coordinator=$!
trap 'stopped=1; kill -TERM "$coordinator"' TERM

# A process of bodies: CPUS PROGRAM WORDS... It lets the coordinator say when it ends.
process() {{
  local cpus=$1
  shift
  srun --exact --nodes=1 --ntasks=1 --cpus-per-task="$cpus" --mem=0 --input=none \
    sh -c 'trap "" TERM; exec "$@"' sh "$@" --connect "$to" --keys "$keys"
}}
{step}
)";

constexpr const char* one_step = R"(step() { process "$@" & })";

constexpr const char* many_steps =
    R"(# For the next stage, and where one is lost, it begins anew while there is a coordinator.
step() {
  while kill -0 "$coordinator" 2> /dev/null; do
    process "$@"
    sleep 1
  done &
})";

constexpr const char* tail = R"(
wait "$coordinator"
code=$?
if [ -n "$stopped" ]; then  # the signal has ended the first wait
  wait "$coordinator"
  code=$?
fi
exit "$code"
)";

void check_option(const std::string& option) {
  const bool one_word = std::ranges::none_of(
      option, [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '#'; });
  if (option.starts_with("--") && option.size() > 2 && one_word) return;
  throw InputError(fmt::format("is no option of sbatch in one word: {}", option), "--sbatch",
                   "Give it as --sbatch=--time=2:00:00.");
}

}  // namespace

std::string slurm_script(const SlurmJob& job, const std::vector<ProcessPlan>& processes) {
  const std::string name = job_name(job.scene);
  int threads = 1;
  std::vector<std::string> names;
  for (const ProcessPlan& process : processes) {
    threads = std::max(threads, process.threads);
    names.push_back(process.name);
  }
  std::string text = fmt::format(
      "#!/bin/bash\n"
      "# A job for sbatch, written by abut slurm: one task is the coordinator, each other one a "
      "process of bodies.\n"
      "# {} s before its time limit it keeps its state and ends; submitted or requeued again it "
      "goes on from there.\n",
      seconds_to_end);
  std::vector<std::string> options{"--job-name=" + name,
                                   fmt::format("--output={}-%j.log", name),
                                   "--open-mode=append",
                                   fmt::format("--ntasks={}", processes.size() + 1),
                                   fmt::format("--cpus-per-task={}", threads),
                                   fmt::format("--signal=B:TERM@{}", seconds_to_end),
                                   "--requeue"};
  for (const std::string& option : job.options) {
    check_option(option);
    options.push_back(option);  // the last one holds
  }
  for (const std::string& option : options) text += fmt::format("#SBATCH {}\n", option);
  std::string overrides;
  for (const std::string& each : job.overrides) overrides += " --set " + quoted_word(each);
  text += fmt::format(fmt::runtime(head), fmt::arg("programs", quoted_word(job.programs)),
                      fmt::arg("scene", quoted_word(job.scene)),
                      fmt::arg("out", quoted_word(job.directory)),
                      fmt::arg("names", fmt::join(names, " ")), fmt::arg("overrides", overrides),
                      fmt::arg("step", job.again ? many_steps : one_step));
  if (std::ranges::any_of(processes, [](const ProcessPlan& each) { return !each.program.empty(); }))
    text +=
        "export PYTHONPATH=\"${PYTHONPATH:+$PYTHONPATH:}${programs}../share/abut/python\"  # as "
        "abut "
        "run does\n";
  for (const ProcessPlan& process : processes) {
    text += fmt::format("step {} ", process.threads);
    text += process.program.empty() ? "\"${programs}abut-solver\" --patience 600"
                                    : quoted_word(process.program);
    for (const std::string& word : process.words()) text += ' ' + quoted_word(word);
    text += '\n';
  }
  return text + tail;
}

}  // namespace abut
