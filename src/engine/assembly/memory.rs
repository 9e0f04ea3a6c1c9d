//! The memory available for particles.

use std::fs::read_to_string;

/// Assumed memory of a machine that does not report it, B.
const UNKNOWN: u64 = 16 << 30;

/// The memory that this process can still take, B.
pub(super) fn free() -> usize {
    let free = [of_machine(), of_process(), of_group()].into_iter().flatten().min();
    usize::try_from(free.unwrap_or(UNKNOWN)).unwrap_or(usize::MAX)
}

/// The available memory of the machine, as Linux reports it, B.
fn of_machine() -> Option<u64> {
    kilobytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// The rest of the limits of the address space (`ulimit -v`) and of the data (`ulimit -d`), B.
fn of_process() -> Option<u64> {
    let (limits, status) =
        (read_to_string("/proc/self/limits").ok()?, read_to_string("/proc/self/status").ok()?);
    let rest =
        |limit: &str, used: &str| Some(soft_limit(&limits, limit)?.saturating_sub(kilobytes(&status, used)?));
    [rest("Max address space", "VmSize:"), rest("Max data size", "VmData:")].into_iter().flatten().min()
}

/// The rest of the limit of the control group of a container or batch job, B.
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

/// The soft limit of that name, B; none where it is unlimited.
fn soft_limit(limits: &str, name: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

fn kilobytes(table: &str, name: &str) -> Option<u64> {
    let line = table.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// The folders of the memory groups of this process and of all around them, of both versions of control
/// groups.
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
                      Max data size             1073741824           unlimited            bytes\n\
                      Max address space         2147483648           unlimited            bytes\n";
        assert_eq!(soft_limit(limits, "Max data size"), Some(1 << 30));
        assert_eq!(soft_limit(limits, "Max address space"), Some(2 << 30));
        assert_eq!(soft_limit(&limits.replace("2147483648", "unlimited "), "Max address space"), None);
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
