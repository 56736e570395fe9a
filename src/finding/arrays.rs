//! Arrays of a fixed length in TOML, whose deserialiser leaves entries beyond it unread.

use serde::de::{Deserialize, Deserializer, Error};

/// Deserialises an array of exactly `N` entries.
///
/// # Errors
/// Those of the entries, and of another length.
pub(crate) fn array<'de, D, T, const N: usize>(deserializer: D) -> Result<[T; N], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let entries = Vec::<T>::deserialize(deserializer)?;
    let found = entries.len();
    entries
        .try_into()
        .map_err(|_| D::Error::custom(format!("{found} entries, expected an array of length {N}")))
}

/// The same of a key that may be left out.
///
/// # Errors
/// As [`array`].
pub(crate) fn optional_array<'de, D, T, const N: usize>(deserializer: D) -> Result<Option<[T; N]>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    array(deserializer).map(Some)
}

/// The same of each entry of a list.
///
/// # Errors
/// As [`array`].
pub(crate) fn arrays<'de, D, T, const N: usize>(deserializer: D) -> Result<Vec<[T; N]>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    struct Entries<T, const N: usize>([T; N]);
    impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Entries<T, N> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            array(deserializer).map(Self)
        }
    }
    let lists = Vec::<Entries<T, N>>::deserialize(deserializer)?;
    Ok(lists.into_iter().map(|entries| entries.0).collect())
}
