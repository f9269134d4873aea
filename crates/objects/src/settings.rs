//! Settings of object storage from the environment: the variables that the AWS tools read.

use std::{env, fmt, time::Duration};

use object_store::{
    BackoffConfig, ClientOptions, RetryConfig,
    aws::{AmazonS3Builder, AmazonS3ConfigKey},
};

use crate::ObjectError;

/// Retries of temporary failures.
#[derive(Debug, Clone, Copy)]
pub struct Retries {
    /// The largest number of retries.
    pub count: usize,
    /// The pause before the first retry. Each later pause is longer by a random factor, at most
    /// twice the pause before.
    pub first_pause: Duration,
    /// The longest pause.
    pub longest_pause: Duration,
}

impl Default for Retries {
    /// Retries for half a minute to two minutes in all, for servers that are overloaded for a
    /// while.
    fn default() -> Self {
        Self {
            count: 10,
            first_pause: Duration::from_millis(200),
            longest_pause: Duration::from_secs(15),
        }
    }
}

/// The access to object storage.
#[derive(Clone)]
pub struct StorageSettings {
    /// Environment variables and their values; only names that begin with `AWS_` are used.
    pub variables: Vec<(String, String)>,
    /// The retries of failed requests.
    pub retries: Retries,
}

impl fmt::Debug for StorageSettings {
    /// Prints only the names of the variables: some of their values are secrets.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.variables.iter().map(|(name, _)| name.as_str()).collect();
        f.debug_struct("StorageSettings").field("variables", &names).finish_non_exhaustive()
    }
}

/// The time limit of all retries: no object takes this long, and credentials are valid for longer.
const RETRY_TIMEOUT: Duration = Duration::from_mins(4);
/// The time limit of one request with its answer, of at most some 16 MiB.
const REQUEST_TIMEOUT: Duration = Duration::from_mins(2);

impl StorageSettings {
    /// Reads the settings from the environment of the process.
    #[must_use]
    pub fn of_environment() -> Self {
        let variables = env::vars_os().filter_map(|(name, value)| {
            let name = name.into_string().ok().filter(|name| name.starts_with("AWS_"))?;
            Some((name, value.into_string().ok()?))
        });
        Self { variables: variables.collect(), retries: Retries::default() }
    }

    /// The endpoint; `None` for AWS.
    #[must_use]
    pub fn endpoint(&self) -> Option<&str> {
        self.get("AWS_ENDPOINT_URL_S3").or_else(|| self.get("AWS_ENDPOINT_URL"))
    }

    /// Whether requests are not signed, as for public buckets.
    #[must_use]
    pub fn is_unsigned(&self) -> bool {
        self.get("AWS_SKIP_SIGNATURE")
            .is_some_and(|value| matches!(value, "1" | "true" | "TRUE" | "True"))
    }

    /// The value of a variable that is not empty.
    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        let found = self.variables.iter().rfind(|(other, _)| other == name);
        found.map(|(_, value)| value.as_str()).filter(|value| !value.is_empty())
    }

    /// Creates the client of a bucket.
    pub(crate) fn builder(&self, bucket: &str) -> Result<AmazonS3Builder, ObjectError> {
        let endpoint = self.endpoint().unwrap_or_default();
        let authority = endpoint.split_once("://").map_or(endpoint, |(_, rest)| rest);
        let authority = authority.split('/').next().unwrap_or_default();
        if authority.contains('@') {
            let what = "AWS_ENDPOINT_URL must not contain a user name or a password".to_owned();
            return Err(ObjectError::Settings { what });
        }
        if !endpoint.is_empty()
            && !endpoint.starts_with("http://")
            && !endpoint.starts_with("https://")
        {
            let what =
                format!("AWS_ENDPOINT_URL must begin with http:// or https://, not {endpoint:?}");
            return Err(ObjectError::Settings { what });
        }
        let mut options = ClientOptions::new()
            .with_timeout(REQUEST_TIMEOUT)
            .with_connect_timeout(Duration::from_secs(10));
        // A user who names an endpoint without TLS wants no TLS.
        if endpoint.starts_with("http://") {
            options = options.with_allow_http(true);
        }
        let Retries { count, first_pause, longest_pause } = self.retries;
        let mut builder =
            AmazonS3Builder::new().with_client_options(options).with_retry(RetryConfig {
                backoff: BackoffConfig {
                    init_backoff: first_pause,
                    max_backoff: longest_pause,
                    base: 2.0,
                },
                max_retries: count,
                retry_timeout: RETRY_TIMEOUT,
            });
        for (name, value) in self.variables.iter().filter(|(_, value)| !value.is_empty()) {
            // Other programs use further variables of this kind.
            if let Ok(key) = name.to_ascii_lowercase().parse::<AmazonS3ConfigKey>()
                && name.starts_with("AWS_")
                && !matches!(key, AmazonS3ConfigKey::Endpoint | AmazonS3ConfigKey::S3Endpoint)
            {
                builder = builder.with_config(key, value.clone());
            }
        }
        if !endpoint.is_empty() {
            builder = builder.with_endpoint(endpoint);
        }
        Ok(builder.with_bucket_name(bucket))
    }
}
