//! The memory of the system and what limits it, as Linux reports them.

use std::fs;
use std::path::{Path, PathBuf};

/// Limits from here on are none: version 1 of control groups has a number for "unlimited".
const UNLIMITED: u64 = 1 << 60;

/// The memory of the system, in bytes; `None` where the system does not report it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// All of it.
    pub total: Option<u64>,
    /// What a program could have without swapping.
    pub available: Option<u64>,
    /// The lowest limit of this process below `total`.
    pub limit: Option<MemoryLimit>,
}

/// A limit of a process's memory, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLimit {
    /// Of its control group: beyond it the process is killed.
    ControlGroup(u64),
    /// Of its addresses: beyond it allocations fail.
    AddressSpace(u64),
}

impl MemoryLimit {
    fn bytes(self) -> u64 {
        match self {
            Self::ControlGroup(bytes) | Self::AddressSpace(bytes) => bytes,
        }
    }
}

impl Memory {
    /// Reads the files of the system under `root`.
    pub fn of_system(root: &Path) -> Self {
        let memory = fs::read_to_string(root.join("proc/meminfo")).unwrap_or_default();
        let kibibytes = |name: &str| {
            let line = memory.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
            Some(line.split_whitespace().next()?.parse::<u64>().ok()? << 10)
        };
        let total = kibibytes("MemTotal");
        let limits = [
            control_group(root).map(MemoryLimit::ControlGroup),
            address_space(root).map(MemoryLimit::AddressSpace),
        ];
        let limit = limits.into_iter().flatten().min_by_key(|limit| limit.bytes());
        Self {
            total,
            available: kibibytes("MemAvailable"),
            limit: limit.filter(|limit| limit.bytes() < total.unwrap_or(UNLIMITED)),
        }
    }
}

/// The lowest limit of this process's control group and of those that it is in.
fn control_group(root: &Path) -> Option<u64> {
    let groups = fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let limits = groups.lines().flat_map(|line| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
        // Version 2 has one hierarchy without names of controllers.
        let (mounted, file) = match controllers {
            "" => ("sys/fs/cgroup", "memory.max"),
            names if names.split(',').any(|name| name == "memory") => {
                ("sys/fs/cgroup/memory", "memory.limit_in_bytes")
            }
            _ => return Vec::new(),
        };
        let group = PathBuf::from(path.trim_start_matches('/'));
        let limit = |group: &Path| {
            let text = fs::read_to_string(root.join(mounted).join(group).join(file)).ok()?;
            text.trim().parse().ok().filter(|&bytes: &u64| bytes < UNLIMITED)
        };
        group.ancestors().filter_map(limit).collect()
    });
    limits.min()
}

/// The limit of `ulimit -v`.
fn address_space(root: &Path) -> Option<u64> {
    let limits = fs::read_to_string(root.join("proc/self/limits")).ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_limit_counts() {
        let root = std::env::temp_dir().join(format!("alhazen-limits-{}", std::process::id()));
        let write = |name: &str, text: &str| {
            let path = root.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        let limit = || Memory::of_system(&root).limit;
        assert_eq!(Memory::of_system(&root), Memory { total: None, available: None, limit: None });
        write("proc/meminfo", "MemTotal:       8388608 kB\nMemFree: 1 kB\nMemAvailable:    4194304 kB\n");
        write("proc/self/limits", "Limit  Soft\nMax address space         unlimited    unlimited    bytes\n");
        write("proc/self/cgroup", "0::/jobs/one\n");
        let memory = Memory::of_system(&root);
        assert_eq!((memory.total, memory.available), (Some(8 << 30), Some(4 << 30)));
        write("sys/fs/cgroup/jobs/one/memory.max", "max\n");
        assert_eq!(limit(), None);
        write("sys/fs/cgroup/jobs/memory.max", "2147483648\n");
        assert_eq!(limit(), Some(MemoryLimit::ControlGroup(2 << 30)));
        write("proc/self/limits", "Max address space         1048576    unlimited    bytes\n");
        assert_eq!(limit(), Some(MemoryLimit::AddressSpace(1 << 20)));
        // Version 1, which has a large number where there is no limit.
        write("proc/self/limits", "");
        write("proc/self/cgroup", "5:cpu,memory:/a\n1:cpuset:/\n");
        write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
        assert_eq!(limit(), None);
        write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "1073741824\n");
        assert_eq!(limit(), Some(MemoryLimit::ControlGroup(1 << 30)));
        fs::remove_dir_all(root).unwrap();
    }
}
