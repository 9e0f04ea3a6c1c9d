//! The number of particles that fit into memory.

use std::fs::read_to_string;

/// What a particle takes in columns, bonds and packed rows, B: the measured figure of a three-dimensional
/// total-Lagrangian body at 54 neighbours, with a margin for the set-up.
const BYTES_PER_PARTICLE: u64 = 1600;

/// Memory of a machine that does not say what it has, B.
const UNKNOWN: u64 = 16 << 30;

/// The largest number of particles that fit the free memory.
pub(super) fn particle_limit() -> usize {
    let free = [of_machine(), of_process(), of_group()].into_iter().flatten().min();
    usize::try_from(free.unwrap_or(UNKNOWN) / BYTES_PER_PARTICLE).unwrap_or(usize::MAX)
}

/// What Linux says is available, B.
fn of_machine() -> Option<u64> {
    kilobytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// What the limit of the address space (`ulimit -v`) leaves, B.
fn of_process() -> Option<u64> {
    let limit = address_space(&read_to_string("/proc/self/limits").ok()?)?;
    let used = kilobytes(&read_to_string("/proc/self/status").ok()?, "VmSize:")?;
    Some(limit.saturating_sub(used))
}

/// What the control group of a container or batch job leaves, B.
fn of_group() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let own = group_folders(&groups).into_iter().filter_map(|folder| {
        let number = |name: &str| read_to_string(format!("{folder}/{name}")).ok()?.trim().parse::<u64>().ok();
        let limit = number("memory.max").or_else(|| number("memory.limit_in_bytes"))?;
        let used = number("memory.current").or_else(|| number("memory.usage_in_bytes")).unwrap_or(0);
        Some(limit.saturating_sub(used))
    });
    own.min()
}

/// The soft limit of the address space; none where it is unlimited.
fn address_space(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

fn kilobytes(table: &str, name: &str) -> Option<u64> {
    let line = table.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// The folders of the memory groups of this process and of all around them, of both versions of control groups.
fn group_folders(groups: &str) -> Vec<String> {
    let mut folders = Vec::new();
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let root = match controllers {
            "" => "/sys/fs/cgroup",
            _ if controllers.split(',').any(|name| name == "memory") => "/sys/fs/cgroup/memory",
            _ => continue,
        };
        let mut path = path.trim_end_matches('/');
        loop {
            folders.push(format!("{root}{path}"));
            let Some((parent, _)) = path.rsplit_once('/') else { break };
            path = parent;
        }
    }
    folders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_as_linux_writes_them() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units\n\
                      Max address space         2147483648           unlimited            bytes\n";
        assert_eq!(address_space(limits), Some(2 << 30));
        assert_eq!(address_space(&limits.replace("2147483648", "unlimited ")), None);
        assert_eq!(kilobytes("MemAvailable:    1024 kB\n", "MemAvailable:"), Some(1 << 20));
    }

    #[test]
    fn groups_are_found_with_those_around_them() {
        assert_eq!(
            group_folders("0::/user.slice/job.scope\n"),
            ["/sys/fs/cgroup/user.slice/job.scope", "/sys/fs/cgroup/user.slice", "/sys/fs/cgroup"]
        );
        assert_eq!(
            group_folders("5:cpu,memory:/docker\n3:cpuset:/\n"),
            ["/sys/fs/cgroup/memory/docker", "/sys/fs/cgroup/memory"]
        );
    }
}
