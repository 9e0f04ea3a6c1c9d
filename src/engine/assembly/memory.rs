//! How many particles this machine can hold.

/// What a particle takes in columns, bonds and packed rows, B: the measured figure of a three-dimensional
/// total-Lagrangian body at 54 neighbours, with a margin for the set-up.
const BYTES_PER_PARTICLE: u64 = 1600;

/// Memory of a machine that does not say what it has, B.
const UNKNOWN: u64 = 16 << 30;

/// The largest number of particles that fit the free memory.
pub(super) fn particle_limit() -> usize {
    let limit = available_bytes().unwrap_or(UNKNOWN) / BYTES_PER_PARTICLE;
    usize::try_from(limit).unwrap_or(usize::MAX)
}

/// What Linux says is available, B.
fn available_bytes() -> Option<u64> {
    let table = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = table.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes * 1024)
}
